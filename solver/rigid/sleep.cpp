// Rest, support and wakes. All decisions are made from the state at the end of a step, in order of
// slots.
#include "solver/rigid/sleep.h"

#include <algorithm>
#include <utility>

#include "engine/base/parallel.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

float weight_N(const Bodies& bodies, BodySlot body, const Vec3& gravity_W) {
  return static_cast<float>(bodies.mass_kg[body] * FroudeScale(gravity_W).gravity_m_s2());
}

/// Returns a speed given in speeds of falling by `reach_m`, at least that of gravity in a step;
/// m/s.
double speed_m_s(double speeds, const StepContext& step, double reach_m) {
  return std::max(speeds * step.froude.speed_m_s(reach_m), step.froude.gravity_m_s2() * step.dt_s);
}

Vec3f up(const Vec3& gravity_W) {
  const double g = gravity_W.norm();
  return g > 0 ? Vec3f((-gravity_W / g).cast<float>()) : Vec3f(Vec3f::Zero());
}

/// Change of a contact's force on its second body.
struct ForceChange {
  Vec3f force_W;
  /// Magnitude of the change, less the ignored fraction of the force before; in N.
  float counted_N;
};

ForceChange change_of(const StepContext& step, const Manifold& m, const Vec3f& before_W) {
  const Vec3f change_W = step.inverse_h * m.impulse_W() - before_W;
  return {change_W, std::max(0.f, change_W.norm() - kIgnoredForceChange * before_W.norm())};
}

bool asleep(const Bodies& bodies, BodySlot body) { return bodies.motion[body] == Motion::kAsleep; }

}  // namespace

void Sleep::update_rest_time(const StepContext& step, Bodies& bodies) {
  for (const BodySlot body : bodies.slots()) {
    if (!bodies.awake(body)) continue;
    const double reach = bodies.reach_m[body];
    const double speed =
        bodies.velocity[body].norm() + bodies.angular_velocity[body].norm() * reach;
    const Quat rotation = bodies.rest_rotation[body].conjugate() * bodies.rotation[body];
    const double drift = (bodies.position[body] - bodies.rest_position[body]).norm() +
                         2 * rotation.vec().norm() * reach;
    const bool slow = speed < speed_m_s(kMaxRestSpeed, step, reach);
    bodies.slow_s[body] = slow ? bodies.slow_s[body] + static_cast<float>(step.dt_s) : 0;
    const double times = double{bodies.slow_s[body]} / step.rest_s(reach);
    const double most_m = std::clamp(times, 1., kPatience) * kMaxRestDrift * reach;
    if (slow && drift < most_m) {
      bodies.resting_s[body] += static_cast<float>(step.dt_s);
    } else {
      bodies.restart_rest(body);
      bodies.rest_position[body] = bodies.position[body];
      bodies.rest_rotation[body] = bodies.rotation[body];
    }
  }
}

/// Removes candidates whose load has just changed by enough to wake them: they may be about to
/// move.
void Sleep::keep_changed_awake(const StepContext& step, const Contacts& contacts,
                               const Bodies& bodies) {
  change_N_.assign(bodies.size(), 0);
  for (const Manifold& m : contacts.manifolds) {
    if (m.count == 0 || !(candidate_[m.body_a] || candidate_[m.body_b])) continue;
    const float change_N = change_of(step, m, m.mean_force_W).counted_N;
    change_N_[m.body_a] += change_N;
    change_N_[m.body_b] += change_N;
  }
  for (const BodySlot body : bodies.slots())
    if (candidate_[body] &&
        change_N_[body] > kWakingForceChange * weight_N(bodies, body, step.gravity_W))
      candidate_[body] = 0;
}

/// Removes candidates that are joined to a moving body.
void Sleep::keep_joined_awake(const Bodies& bodies, const Joints& joints) {
  for (bool again = true; again;) {
    again = false;
    for (const Joint& joint : joints.all()) {
      if (!joint.holds() || joint.body_a.none() || joint.body_b.none()) continue;
      for (const auto& [one, other] :
           {std::pair(joint.body_a, joint.body_b), {joint.body_b, joint.body_a}}) {
        const bool moves = bodies.awake(other) || bodies.is_shifting_kinematic(other);
        if (!candidate_[one] || candidate_[other] || !moves) continue;
        candidate_[one] = 0;
        again = true;
      }
    }
  }
}

void Sleep::anchor_by_joints(const Bodies& bodies, const Joints& joints, DisjointSets& groups) {
  for (const Joint& joint : joints.all()) {
    if (!joint.holds()) continue;
    const auto rests = [&](BodySlot body) {
      return !body.none() && (candidate_[body] || asleep(bodies, body));
    };
    const auto immovable = [&](BodySlot body) { return body.none() || !bodies.dynamic(body); };
    const BodySlot a = joint.body_a, b = joint.body_b;
    if (rests(a) && rests(b)) groups.join(a.value, b.value);
    if (rests(a) && immovable(b)) anchored_[a] = 1;
    if (rests(b) && immovable(a)) anchored_[b] = 1;
  }
}

double Sleep::put_to_sleep(const StepContext& step, const Joints& joints, Bodies& bodies,
                           Contacts& contacts) {
  update_rest_time(step, bodies);
  const std::uint32_t n = bodies.size();
  candidate_.assign(n, 0);
  bool any = false;
  for (const BodySlot body : bodies.slots()) {
    candidate_[body] =
        bodies.awake(body) && double{bodies.resting_s[body]} >= step.rest_s(bodies.reach_m[body]);
    any = any || candidate_[body];
  }
  if (!any) return {};
  for (const Manifold& m : contacts.manifolds) {
    if (m.count == 0) continue;
    if (bodies.is_shifting_kinematic(m.body_b)) candidate_[m.body_a] = 0;
    if (bodies.is_shifting_kinematic(m.body_a)) candidate_[m.body_b] = 0;
  }
  keep_changed_awake(step, contacts, bodies);
  keep_joined_awake(bodies, joints);
  DisjointSets groups(n);  // bodies at rest in contact with each other
  anchored_.assign(n, step.gravity_W.isZero(0));
  auto rests = [&](BodySlot body) { return candidate_[body] || asleep(bodies, body); };
  for (const Manifold& m : contacts.manifolds) {
    if (m.count == 0 || m.normal_impulse() <= 0) continue;
    const bool a = rests(m.body_a), b = rests(m.body_b);
    if (a && b) {
      groups.join(m.body_a.value, m.body_b.value);
    } else if (a && !bodies.dynamic(m.body_b)) {
      anchored_[m.body_a] = 1;
    } else if (b && !bodies.dynamic(m.body_a)) {
      anchored_[m.body_b] = 1;
    }
  }
  anchor_by_joints(bodies, joints, groups);
  const auto root = [&](BodySlot body) { return BodySlot(groups.root(body.value)); };
  for (const BodySlot body : bodies.slots())
    if (anchored_[body] && rests(body)) anchored_[root(body)] = 1;
  double taken_J = 0;
  for (const BodySlot body : bodies.slots()) {
    candidate_[body] = candidate_[body] && anchored_[root(body)];
    if (!candidate_[body]) continue;
    taken_J += bodies.kinetic_J(body);
    bodies.motion[body] = Motion::kAsleep;
    bodies.velocity[body].setZero();
    bodies.angular_velocity[body].setZero();
  }
  for (Manifold& m : contacts.manifolds)
    if (m.count > 0 && (candidate_[m.body_a] || candidate_[m.body_b]))
      m.rest_force_W = step.inverse_h * m.impulse_W();
  return taken_J;
}

void Sleep::wake_by_load(const StepContext& step, ContactFinder& finder, Bodies& bodies) {
  change_N_.assign(bodies.size(), 0);
  support_N_.assign(bodies.size(), 0);
  const Vec3f up_W = up(step.gravity_W);
  for (const Manifold& m : finder.contacts().manifolds) {
    if (m.count == 0) continue;
    const bool a = asleep(bodies, m.body_a), b = asleep(bodies, m.body_b);
    if (a == b || !bodies.awake(a ? m.body_b : m.body_a)) continue;
    const BodySlot body = a ? m.body_a : m.body_b;
    const ForceChange change = change_of(step, m, m.rest_force_W);
    change_N_[body] += change.counted_N;
    support_N_[body] += (a ? -1.f : 1.f) * change.force_W.dot(up_W);
  }
  std::vector<BodySlot> woken, left;
  for (const BodySlot body : bodies.slots()) {
    if (!asleep(bodies, body)) continue;
    const float weight = weight_N(bodies, body, step.gravity_W);
    if (change_N_[body] <= kWakingForceChange * weight) continue;
    (support_N_[body] < -kSupportingForce * weight ? left : woken).push_back(body);
  }
  for (const BodySlot body : woken) bodies.wake(body);
  wake_above(std::move(left), step.gravity_W, finder, bodies);
}

void Sleep::wake_unsupported(std::span<const ManifoldSlot> manifolds, const Vec3& gravity_W,
                             ContactFinder& finder, Bodies& bodies) {
  std::vector<BodySlot> lowest;
  for (const ManifoldSlot slot : manifolds) {
    const Manifold& m = finder.contacts().manifolds[slot];
    for (const BodySlot body : {m.body_a, m.body_b}) {
      if (!bodies.dynamic(body) || !(bodies.resting_s[body] > 0)) continue;
      const float rest_N = asleep(bodies, body) ? m.rest_force_W.norm() : 0;
      bodies.lost_N[body] += std::max(rest_N, m.mean_force_W.norm());
      if (double{bodies.lost_N[body]} <=
          kMaxLostSupport * double{weight_N(bodies, body, gravity_W)})
        continue;
      lowest.push_back(body);
      bodies.restart_rest(body);
    }
  }
  std::sort(lowest.begin(), lowest.end());
  lowest.erase(std::unique(lowest.begin(), lowest.end()), lowest.end());
  wake_above(std::move(lowest), gravity_W, finder, bodies);
}

void Sleep::wake_joined(const Joint& joint, const Vec3& gravity_W, ContactFinder& finder,
                        Bodies& bodies) {
  if (!joint.has_load()) return;
  std::vector<BodySlot> held;
  for (const BodySlot body : {joint.body_a, joint.body_b})
    if (!body.none() && bodies.dynamic(body)) held.push_back(body);
  wake_above(std::move(held), gravity_W, finder, bodies);
}

void Sleep::wake_on_kinematic(const Vec3& gravity_W, ContactFinder& finder, Bodies& bodies) {
  const auto shifts = [&](BodySlot body) { return bodies.is_shifting_kinematic(body); };
  bool any = false;
  for (const BodySlot body : bodies.slots()) any = any || shifts(body);
  if (!any) return;
  std::vector<BodySlot> carried;
  for (const Manifold& m : finder.contacts().manifolds) {
    if (m.count == 0) continue;
    if (shifts(m.body_b) && asleep(bodies, m.body_a)) carried.push_back(m.body_a);
    if (shifts(m.body_a) && asleep(bodies, m.body_b)) carried.push_back(m.body_b);
  }
  wake_above(std::move(carried), gravity_W, finder, bodies);
}

void Sleep::wake_above(std::vector<BodySlot> lowest, const Vec3& gravity_W, ContactFinder& finder,
                       Bodies& bodies) {
  const Vec3f up_W = up(gravity_W);
  for (const BodySlot body : lowest) bodies.wake(body);
  while (!lowest.empty()) {
    const BodySlot low = lowest.back();
    lowest.pop_back();
    for (const ManifoldSlot slot : finder.of(low)) {
      const Manifold& m = finder.contacts().manifolds[slot];
      const BodySlot high = m.body_a == low ? m.body_b : m.body_a;
      const float lift = (m.body_a == low ? 1.f : -1.f) * m.rest_force_W.dot(up_W);
      if (!asleep(bodies, high) || !(lift > kSupportingForce * weight_N(bodies, high, gravity_W)))
        continue;
      bodies.wake(high);
      lowest.push_back(high);
    }
  }
}

}  // namespace sunder::solver
