// Union-find over loaded contacts; the root of an island is its least slot.
#include "solver/rigid/islands.h"

#include <algorithm>

#include "solver/rigid/approach.h"

namespace sunder::solver {
namespace {

constexpr double kSlow_m_s = 0.05;
constexpr float kSlowTime_s = 0.5f;

}  // namespace

std::uint32_t Islands::root(std::uint32_t body) {
  while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
  return body;
}

Vec3 Islands::put_to_sleep(const Contacts& contacts, double dt_s, Bodies& bodies) {
  const std::uint32_t n = bodies.size();
  parent_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    parent_[i] = i;
    if (!bodies.awake(i)) continue;
    const double speed =
        bodies.velocity[i].norm() + bodies.angular_velocity[i].norm() * bodies.reach_m[i];
    bodies.slow_s[i] = speed < kSlow_m_s ? bodies.slow_s[i] + static_cast<float>(dt_s) : 0.f;
  }
  for (const Manifold& m : contacts.manifolds) {
    if (m.count == 0 || !bodies.awake(m.body_a) || !bodies.awake(m.body_b)) continue;
    if (m.normal_impulse() <= 0) continue;
    const std::uint32_t a = root(m.body_a), b = root(m.body_b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  least_slow_s_.assign(n, 1e30f);
  last_asleep_.assign(n, kNone);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (!bodies.awake(i)) continue;
    float& least = least_slow_s_[root(i)];
    least = std::min(least, bodies.slow_s[i]);
  }
  Vec3 taken = Vec3::Zero();
  for (std::uint32_t i = 0; i < n; ++i) {
    if (!bodies.awake(i)) continue;
    const std::uint32_t island = root(i);
    if (least_slow_s_[island] < kSlowTime_s) continue;
    taken -= bodies.mass_kg[i] * bodies.velocity[i];
    bodies.motion[i] = Motion::kAsleep;
    bodies.velocity[i].setZero();
    bodies.angular_velocity[i].setZero();
    // A ring through the island: from the newest to the first, and from the last one here.
    const std::uint32_t last = last_asleep_[island];
    bodies.next_asleep[i] = last == kNone ? i : bodies.next_asleep[last];
    if (last != kNone) bodies.next_asleep[last] = i;
    last_asleep_[island] = i;
  }
  return taken;
}

bool Islands::wake_touched(const Contacts& contacts, double dt_s, Bodies& bodies) const {
  std::vector<std::uint32_t> woken;
  for (const Manifold& m : contacts.manifolds) {
    if (m.count == 0) continue;
    const bool a = bodies.awake(m.body_a), b = bodies.awake(m.body_b);
    if (a == b || !bodies.dynamic(m.body_a) || !bodies.dynamic(m.body_b)) continue;
    for (std::size_t i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[i];
      if (double{p.separation_m} > dt_s * closing_speed(m, bodies, p.arm_A, p.arm_B)) continue;
      woken.push_back(a ? m.body_b : m.body_a);
      break;
    }
  }
  for (const std::uint32_t body : woken) bodies.wake(body);
  return !woken.empty();
}

}  // namespace sunder::solver
