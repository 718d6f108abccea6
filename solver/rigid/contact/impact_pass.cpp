#include "solver/rigid/contact/impact_pass.h"

#include <algorithm>

namespace sunder::solver {
namespace {

constexpr float kOverRelaxed = 1.75f;  // best for a row of 22 (Young 1954): 2 / (1 + sin(π / 23))
constexpr int kMostWork = 150000;      // maximum of sweeps times manifolds in a substep

}  // namespace

void ImpactPass::clear() {
  colors_.clear();
  bodies_.clear();
  manifolds_ = 0;
  was_cut_off_ = false;
}

void ImpactPass::add(std::uint32_t first, std::uint32_t end, std::uint32_t manifold,
                     std::uint32_t manifolds) {
  if (manifolds > 0) colors_.push_back({first, end, manifold, manifolds});
  manifolds_ += static_cast<int>(manifolds);
}

void ImpactPass::begin(const Impacts& impacts, std::span<const BodySlot> active, std::size_t rows,
                       std::size_t kinematic, ContactBlocks& blocks) {
  if (empty()) return;
  blocks.allocate_impacts(colors_.back().manifold + colors_.back().manifolds);
  for (const BodySlot body : active)
    if (impacts.may_move(body)) bodies_.push_back(body);
  velocity_.resize(bodies_.size());
  moved_.resize(rows);
  kinematic_ = kinematic;
}

void ImpactPass::prepare(const ContactStep& step, ContactBlocks& blocks) const {
  for_blocks([&](auto first, auto end) { blocks.prepare_impact(first, end, step); });
}

void ImpactPass::run(const ContactStep& step, ContactBlocks& blocks) {
  subtract_impulses(step.rows.rows);
  bool any_impact = false;
  for_blocks([&](auto first, auto end) { any_impact |= blocks.find_gaps(first, end, step); });
  if (any_impact) {
    for_blocks([&](auto first, auto end) { blocks.extract_contacts(first, end); });
    sweep(step, blocks);
    restore_velocities(step.rows.rows);  // removes the rounding errors of many sweeps
    for_blocks([&](auto first, auto end) { blocks.apply_propagation(first, end, step); });
  }
  add_impulses(step.rows.rows);
}

void ImpactPass::sweep(const ContactStep& step, ContactBlocks& blocks) {
  std::ranges::fill(moved_, std::uint8_t{0});
  ImpactSweep sweep{moved_.data() + kinematic_};
  const auto once = [&](const ContactStep& with) {
    ++sweep.now;
    bool closes = false;
    for (const Color& color : colors_)
      closes |= blocks.propagate(color.manifold, color.manifolds, with, sweep);
    return closes;
  };
  ContactStep over_relaxed = step;
  over_relaxed.soft.omega = kOverRelaxed;
  const int most = std::min(kMostSweeps, kMostWork / manifolds_);
  bool closes = true;
  for (int i = 1; i < most && (closes = once(over_relaxed)); ++i) sweep.since = sweep.now;
  was_cut_off_ |= closes;
  sweep.since = std::min<std::uint8_t>(sweep.now, 1);  // all bodies that an impact reached
  once(step), once(step);  // friction uses the normal impulses of the previous sweep
}

void ImpactPass::subtract_impulses(BodyRow* rows) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyRow& r = rows[row_of(bodies_[i])];
    velocity_[i] = r.velocity;
    r.velocity = r.base;
  }
}

void ImpactPass::restore_velocities(BodyRow* rows) const {
  for (const BodySlot body : bodies_) rows[row_of(body)].velocity = rows[row_of(body)].base;
}

void ImpactPass::add_impulses(BodyRow* rows) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyRow& r = rows[row_of(bodies_[i])];
    const Wide passed = r.velocity - r.base;
    r.base = r.velocity;
    r.velocity = velocity_[i] + passed;
  }
}

}  // namespace sunder::solver
