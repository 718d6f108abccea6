#include "solver/rigid/contact/impact_pass.h"

#include <cstdio>
#include <cstdlib>

namespace sunder::solver {
namespace {

constexpr float kOverRelaxed = 1.8f;
constexpr int kMostSweeps = 64;   // a substep
constexpr int kLook = 4;          // whenever so many more are done: is it enough?
constexpr double kPassed = 1e-3;  // of the energy with which contacts close, when the step begins

}  // namespace

void ImpactPass::clear() {
  blocks_.clear();
  bodies_.clear();
  manifolds_ = 0;
  work_ = 0;
}

void ImpactPass::add(std::uint32_t first, std::uint32_t end, std::uint32_t manifolds) {
  if (manifolds > 0) blocks_.emplace_back(first, end);
  manifolds_ += manifolds;
}

void ImpactPass::begin(const Impacts& impacts, std::span<const BodySlot> active,
                       ContactBlocks& blocks) {
  blocks.expect_impacts();
  for (const BodySlot body : active)
    if (impacts.moves(body)) bodies_.push_back(body);
  velocity_.resize(bodies_.size());
  impact_J_ = -1;
}

void ImpactPass::run(const ContactStep& step, ContactBlocks& blocks) {
  if (impact_J_ < 0) {
    const float f = getenv("FAST") ? float(atof(getenv("FAST"))) : 0.25f;
    for_blocks([&](auto first, auto end) {
      blocks.expect_impacts(first, end, step, f / static_cast<float>(step.context.dt_s));
    });
  }
  set_aside(step.rows.rows);
  double left_J = closing_J(step, blocks);
  if (impact_J_ < 0) impact_J_ = left_J;
  if (left_J > kPassed * impact_J_) {
    ContactStep over_relaxed = step;
    over_relaxed.soft.omega = kOverRelaxed;
    for_blocks([&](auto first, auto end) { blocks.begin_impact(first, end); });
    for (int i = 1; i < kMostSweeps && left_J > kPassed * impact_J_; ++i) {
      sweep(over_relaxed, blocks);
      if (i % kLook == 0) left_J = closing_J(step, blocks);
    }
    sweep(step, blocks);
    for_blocks([&](auto first, auto end) { blocks.end_impact(first, end); });
  }
  if (getenv("SAY")) {
    std::uint32_t nb = 0;
    for_blocks([&](auto f, auto e) { nb += e - f; });
    fprintf(stderr, "IMP bodies %zu manifolds %u blocks %u colors %zu J0 %g J %g work %lu\n",
            bodies_.size(), manifolds_, nb, blocks_.size(), impact_J_, left_J, work_ / manifolds_);
  }
  put_back(step.rows.rows);
}

double ImpactPass::closing_J(const ContactStep& step, const ContactBlocks& blocks) const {
  double sum = 0;
  for_blocks([&](auto first, auto end) { blocks.add_closing_J(first, end, step, sum); });
  return sum;
}

void ImpactPass::sweep(const ContactStep& step, ContactBlocks& blocks) {
  for_blocks([&](auto first, auto end) { blocks.sweep_relaxed(first, end, step); });
  work_ += manifolds_;
}

void ImpactPass::set_aside(BodyRow* rows) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyRow& r = rows[row_of(bodies_[i])];
    velocity_[i] = r.velocity;
    r.velocity = r.base;
  }
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
