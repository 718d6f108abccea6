#include "solver/rigid/contact/impact_pass.h"

#include <algorithm>

namespace sunder::solver {
namespace {

constexpr float kOverRelaxed = 1.75f;  // best for a row of 22 (Young 1954): 2 / (1 + sin(π / 23))
constexpr int kMostWork = 150000;      // sweeps of a manifold in a substep

}  // namespace

void ImpactPass::clear() {
  blocks_.clear();
  bodies_.clear();
  manifolds_ = 0;
}

void ImpactPass::add(std::uint32_t first, std::uint32_t end, std::uint32_t manifolds) {
  if (manifolds > 0) blocks_.emplace_back(first, end);
  manifolds_ += static_cast<int>(manifolds);
}

void ImpactPass::begin(const Impacts& impacts, std::span<const BodySlot> active,
                       ContactBlocks& blocks) {
  if (empty()) return;
  blocks.expect_impacts();
  for (const BodySlot body : active)
    if (impacts.moves(body)) bodies_.push_back(body);
  velocity_.resize(bodies_.size());
}

void ImpactPass::prepare(const ContactStep& step, ContactBlocks& blocks) const {
  for_blocks([&](auto first, auto end) { blocks.prepare_impact(first, end, step); });
}

void ImpactPass::run(const ContactStep& step, ContactBlocks& blocks) {
  set_aside(step.rows.rows);
  if (closes_fast(step, blocks)) {
    for_blocks([&](auto first, auto end) { blocks.begin_impact(first, end); });
    sweep(step, blocks);
    take_back(step.rows.rows);  // what many sweeps round off would add up
    for_blocks([&](auto first, auto end) { blocks.warm_start(first, end, step); });
    for_blocks([&](auto first, auto end) { blocks.end_impact(first, end); });
  }
  put_back(step.rows.rows);
}

bool ImpactPass::closes_fast(const ContactStep& step, const ContactBlocks& blocks) const {
  return std::ranges::any_of(blocks_, [&](const auto& of_color) {
    return blocks.closes_fast(of_color.first, of_color.second, step);
  });
}

void ImpactPass::sweep(const ContactStep& step, ContactBlocks& blocks) const {
  const auto once = [&](const ContactStep& with) {
    for_blocks([&](auto first, auto end) { blocks.sweep_relaxed(first, end, with); });
  };
  ContactStep over_relaxed = step;
  over_relaxed.soft.omega = kOverRelaxed;
  const int most = std::min(kMostSweeps, kMostWork / manifolds_);
  for (int i = 1; i < most && closes_fast(step, blocks); ++i) once(over_relaxed);
  once(step), once(step);  // friction goes by the load of the sweep before
}

void ImpactPass::set_aside(BodyRow* rows) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyRow& r = rows[row_of(bodies_[i])];
    velocity_[i] = r.velocity;
    r.velocity = r.base;
  }
}

void ImpactPass::take_back(BodyRow* rows) const {
  for (const BodySlot body : bodies_) rows[row_of(body)].velocity = rows[row_of(body)].base;
}

void ImpactPass::put_back(BodyRow* rows) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyRow& r = rows[row_of(bodies_[i])];
    const Wide passed = r.velocity - r.base;
    r.base = r.velocity;
    r.velocity = velocity_[i] + passed;
  }
}

}  // namespace sunder::solver
