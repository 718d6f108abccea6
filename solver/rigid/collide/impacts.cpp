#include "solver/rigid/collide/impacts.h"

#include <algorithm>

#include "solver/rigid/collide/approach.h"
#include "solver/rigid/tolerances.h"

namespace sunder::solver {
namespace {

/// No impact is slower.
double slow_m_s(const StepContext& step) { return 2 * kSlowFalls * step.fall_m_s; }

/// Of two that meet in an impact, one is at least half as fast: what lies still has none.
bool any_fast(const StepContext& step, const Bodies& bodies) {
  for (const BodySlot body : bodies.slots())
    if (bodies.awake(body) && 2 * bodies.fastest_m_s(body) > slow_m_s(step)) return true;
  return false;
}

bool meet_fast(const StepContext& step, const Manifold& m, const Bodies& bodies) {
  if (!bodies.dynamic(m.body_a) || !bodies.dynamic(m.body_b)) return false;
  const double least_m_s = least_impact_m_s(step, m);
  return std::any_of(m.points.begin(), m.points.begin() + m.count, [&](const ManifoldPoint& p) {
    const double speed_m_s = closing_speed(m, bodies, p.arm_A, p.arm_B);
    return speed_m_s > least_m_s && step.dt_s * speed_m_s > double{p.separation_m};
  });
}

template <class Visit>
void for_touching(const Bodies& bodies, const Contacts& contacts, const Visit& visit) {
  for (const ManifoldSlot i : contacts.manifolds.slots()) {
    const Manifold& m = contacts.manifolds[i];
    if (touches_awake(m, bodies)) visit(m);
  }
}

}  // namespace

double least_impact_m_s(const StepContext& step, const Manifold& m) {
  return std::max(0.5 * double{kFar} * double{m.size_m} / step.dt_s, slow_m_s(step));
}

void Impacts::find(const StepContext& step, const Bodies& bodies, const Contacts& contacts) {
  clear();
  if (!any_fast(step, bodies)) return;
  for_touching(bodies, contacts, [&](const Manifold& m) {
    if (!meet_fast(step, m, bodies)) return;
    if (steps_.empty()) steps_.assign(bodies.size(), kUnreached);
    steps_[m.body_a] = steps_[m.body_b] = 0;
  });
  if (!steps_.empty()) spread(bodies, contacts);
}

void Impacts::spread(const Bodies& bodies, const Contacts& contacts) {
  for (std::uint8_t steps = 0; steps < kReach; ++steps) {
    const auto pass_on = [&](BodySlot from, BodySlot to) {
      if (steps_[from] == steps && steps_[to] > steps + 1 && bodies.awake(to))
        steps_[to] = static_cast<std::uint8_t>(steps + 1);
    };
    for_touching(bodies, contacts, [&](const Manifold& m) {
      pass_on(m.body_a, m.body_b), pass_on(m.body_b, m.body_a);
    });
  }
}

}  // namespace sunder::solver
