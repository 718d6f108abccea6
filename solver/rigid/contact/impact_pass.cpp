#include "solver/rigid/contact/impact_pass.h"

#include <algorithm>
#include <cstdlib>

namespace sunder::solver {
namespace {

constexpr float kOverRelaxed = 1.8f;
constexpr double kPassed = 1e-3;             // of the energy of impacts: what may be left
constexpr float kShareLeft = 0.3f;           // of the least speed of an impact: slower has passed
constexpr std::uint32_t kMostWork = 150000;  // sweeps of a manifold in a substep, but for
constexpr std::uint32_t kLeastSweeps = 4;    // so many of each
constexpr std::uint32_t kLook = 4;           // whenever so many sweeps more are done: is it enough?

}  // namespace

void ImpactPass::clear() {
  blocks_.clear();
  bodies_.clear();
  manifolds_ = 0;
  sweeps_ = 0;
}

void ImpactPass::add(std::uint32_t first, std::uint32_t end, std::uint32_t manifolds) {
  if (manifolds > 0) blocks_.emplace_back(first, end);
  manifolds_ += manifolds;
}

void ImpactPass::begin(const Impacts& impacts, std::span<const BodySlot> active) {
  for (const BodySlot body : active)
    if (impacts.moves(body)) bodies_.push_back(body);
  velocity_.resize(bodies_.size());
  impact_J_ = 0;
}

void ImpactPass::run(const ContactStep& step, ContactBlocks& blocks) {
  set_aside(step.rows.rows);
  const double closing = closing_J(step, blocks, 1);
  impact_J_ = std::max(impact_J_, closing);
  if (closing > kPassed * impact_J_) {
    for_blocks([&](auto first, auto end) { blocks.begin_impact(first, end); });
    sweep(step, blocks);
    take_back(step.rows.rows);  // what many sweeps round off would add up
    for_blocks([&](auto first, auto end) { blocks.warm_start(first, end, step); });
    for_blocks([&](auto first, auto end) { blocks.end_impact(first, end); });
  }
  put_back(step.rows.rows);
}

void ImpactPass::sweep(const ContactStep& step, ContactBlocks& blocks) {
  const auto once = [&](const ContactStep& with) {
    for_blocks([&](auto first, auto end) { blocks.sweep_relaxed(first, end, with); });
    ++sweeps_;
  };
  ContactStep over_relaxed = step;
  over_relaxed.soft.omega = kOverRelaxed;
  const std::uint32_t most = std::clamp(kMostWork / manifolds_, kLeastSweeps, kMostSweeps);
  for (std::uint32_t i = 1; i < most; ++i) {
    once(over_relaxed);
    if (i % kLook == 0 && closing_J(step, blocks, kShareLeft) <= kPassed * impact_J_) break;
  }
  once(step);
}

double ImpactPass::closing_J(const ContactStep& step, const ContactBlocks& blocks,
                             float share) const {
  double sum = 0;
  for_blocks([&](auto first, auto end) { blocks.add_closing_J(first, end, step, share, sum); });
  return sum;
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
