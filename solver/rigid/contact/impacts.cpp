#include "solver/rigid/contact/impacts.h"

#include <algorithm>
#include <utility>

#include "solver/rigid/collide/approach.h"

namespace sunder::solver {
namespace {

constexpr double kHeavy = 4;    // times the mass of what it strikes
constexpr double kFast = 0.25;  // in a step, of the inner radius of the smaller shape,
constexpr double kFalls = 4;    // and in what falls from rest within the step

/// Whether something heavy strikes something light.
bool strikes(const StepContext& step, const Manifold& m, const Bodies& bodies) {
  const BodySlot a = m.body_a, b = m.body_b;
  if (!bodies.dynamic(a) || !bodies.dynamic(b)) return false;
  const auto [light_kg, heavy_kg] = std::minmax(bodies.mass_kg[a], bodies.mass_kg[b]);
  if (heavy_kg < kHeavy * light_kg) return false;
  const double least_m = std::max(kFast * double{m.size_m}, kFalls * double{step.fall_m});
  return std::any_of(m.points.begin(), m.points.begin() + m.count, [&](const ManifoldPoint& p) {
    const double way_m = step.dt_s * closing_speed(m, bodies, p.arm_A, p.arm_B);
    return way_m > least_m && way_m > double{p.separation_m};
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

void Impacts::find(const StepContext& step, const Bodies& bodies, const Contacts& contacts) {
  steps_.clear();
  for_touching(bodies, contacts, [&](const Manifold& m) {
    if (!strikes(step, m, bodies)) return;
    if (steps_.empty()) steps_.assign(bodies.size(), kFar);
    const bool a_strikes = bodies.mass_kg[m.body_a] > bodies.mass_kg[m.body_b];
    steps_[a_strikes ? m.body_b : m.body_a] = 0;
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
