#include "solver/rigid/collide/impacts.h"

#include <algorithm>

#include "solver/rigid/collide/approach.h"
#include "solver/rigid/tolerances.h"

namespace sunder::solver {
namespace {

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
    if (m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b))) visit(m);
  }
}

}  // namespace

double least_impact_m_s(const StepContext& step, const Manifold& m) {
  return std::max(0.5 * double{kFar} * double{m.size_m} / step.dt_s,
                  2 * kSlowFalls * step.fall_m_s);
}

void Impacts::find(const StepContext& step, const Bodies& bodies, const Contacts& contacts) {
  clear();
  for_touching(bodies, contacts, [&](const Manifold& m) {
    if (!meet_fast(step, m, bodies)) return;
    if (steps_.empty()) steps_.assign(bodies.size(), kFar);
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
