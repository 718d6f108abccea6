#include "solver/rigid/collide/impacts.h"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/base/parallel.h"
#include "solver/rigid/collide/speculative_contacts.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// Minimum speed of any impact.
double slow_m_s(const StepContext& step) { return kMinImpactSpeed * step.fall_m_s; }

constexpr std::size_t kBodies = 1024, kManifolds = 512;  // number in a chunk

/// Returns an upper bound on the speed of a body's contact points, which lie within twice its
/// reach.
ByBody<double> find_fastest(const Bodies& bodies) {
  ByBody<double> fastest_m_s(bodies.size());
  for_chunks(bodies.size(), kBodies, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (BodySlot body(begin); body.value < end; ++body.value) {
      const double spin_m_s = bodies.angular_velocity[body].norm() * bodies.reach_m[body];
      fastest_m_s[body] = bodies.velocity[body].norm() + 2 * spin_m_s;
    }
  });
  return fastest_m_s;
}

bool is_impact(const StepContext& step, const Manifold& m, const Bodies& bodies,
               const ByBody<double>& fastest_m_s) {
  if (!bodies.dynamic(m.body_a) || !bodies.dynamic(m.body_b)) return false;
  const double least_m_s = least_impact_m_s(step, m);
  if (fastest_m_s[m.body_a] + fastest_m_s[m.body_b] < least_m_s) return false;
  return std::any_of(m.points.begin(), m.points.begin() + m.count, [&](const ManifoldPoint& p) {
    const double speed_m_s = closing_speed(m, bodies, p.arm_A, p.arm_B);
    return speed_m_s > least_m_s && step.dt_s * speed_m_s > double{p.separation_m};
  });
}

/// Bodies of the awake contacts in a chunk of manifolds, and the contacts with an impact.
struct ChunkContacts {
  std::vector<std::array<BodySlot, 2>> touching;
  std::vector<std::uint32_t> struck;  ///< Indices into `touching`.
};

std::vector<ChunkContacts> find_contacts(const StepContext& step, const Bodies& bodies,
                                         const Contacts& contacts,
                                         const ByBody<double>& fastest_m_s) {
  const std::size_t all = contacts.manifolds.size();
  std::vector<ChunkContacts> found((all + kManifolds - 1) / kManifolds);
  for_chunks(all, kManifolds, [&](std::size_t begin, std::size_t end, std::size_t c) {
    for (ManifoldSlot i(begin); i.value < end; ++i.value) {
      const Manifold& m = contacts.manifolds[i];
      if (!touches_awake(m, bodies)) continue;
      if (is_impact(step, m, bodies, fastest_m_s))
        found[c].struck.push_back(static_cast<std::uint32_t>(found[c].touching.size()));
      found[c].touching.push_back({m.body_a, m.body_b});
    }
  });
  return found;
}

}  // namespace

double least_impact_m_s(const StepContext& step, const Manifold& m) {
  return std::max(double{kImpactMotion} * double{m.size_m} / step.dt_s, slow_m_s(step));
}

void Impacts::find(const StepContext& step, const Bodies& bodies, const Contacts& contacts) {
  clear();
  const ByBody<double> fastest_m_s = find_fastest(bodies);
  // One of two bodies in an impact has at least half of its speed, so bodies at rest have none.
  const auto fast = [&](double speed_m_s) { return 2 * speed_m_s > slow_m_s(step); };
  if (std::none_of(fastest_m_s.begin(), fastest_m_s.end(), fast)) return;
  const std::vector<ChunkContacts> found = find_contacts(step, bodies, contacts, fastest_m_s);
  for (const ChunkContacts& chunk : found) {
    if (!chunk.struck.empty() && distance_.empty()) distance_.assign(bodies.size(), kUnreached);
    for (const std::uint32_t i : chunk.struck)
      for (const BodySlot body : chunk.touching[i]) distance_[body] = 0;
  }
  if (distance_.empty()) return;
  for (std::uint8_t distance = 0; distance < kMaxDistance; ++distance) {
    const auto pass_on = [&](BodySlot from, BodySlot to) {
      if (distance_[from] == distance && distance_[to] > distance + 1 && bodies.awake(to))
        distance_[to] = static_cast<std::uint8_t>(distance + 1);
    };
    for (const ChunkContacts& chunk : found)
      for (const auto& [a, b] : chunk.touching) pass_on(a, b), pass_on(b, a);
  }
}

}  // namespace sunder::solver
