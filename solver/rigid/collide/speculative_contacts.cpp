// Finds speculative contacts from manifolds and the velocities before the solve.
#include "solver/rigid/collide/speculative_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

double inverse_effective_mass(const Bodies& bodies, BodySlot body, const Vec3f& arm_W,
                              const Vec3f& normal_W) {
  if (!bodies.dynamic(body)) return 0;
  const Vec3f angular_B = bodies.rotation_f[body].transpose() * arm_W.cross(normal_W);
  return static_cast<double>(bodies.inverse_mass[body] +
                             (bodies.root_B[body].transpose() * angular_B).squaredNorm());
}

/// True if no point can close fast enough to count. A point is on its body, or farther by no more
/// than a slow closing and a fall in a step: twice the speed of the bodies is an upper bound.
bool is_slow(const Manifold& m, const Bodies& bodies, const StepContext& step) {
  return 2 * (bodies.fastest_m_s(m.body_a) + bodies.fastest_m_s(m.body_b)) < step.rest_speed_m_s;
}

/// Finds the mean of the points that may close within the step; returns false if none does.
bool closing_middle(const Manifold& m, const Bodies& bodies, const StepContext& step, Vec3f& arm_A,
                    Vec3f& arm_B, float& separation_m) {
  int closing = 0;
  arm_A.setZero(), arm_B.setZero();
  separation_m = 1e30f;
  for (std::size_t i = 0; i < m.count; ++i) {
    const ManifoldPoint& p = m.points[i];
    const double speed = closing_speed(m, bodies, p.arm_A, p.arm_B);
    if (speed < step.rest_speed_m_s) continue;
    if (double{p.separation_m} > speed * step.dt_s + 0.5 * double{step.fall_m}) continue;
    ++closing;
    arm_A += p.arm_A, arm_B += p.arm_B;
    separation_m = std::min(separation_m, p.separation_m);
  }
  if (closing == 0) return false;
  arm_A /= static_cast<float>(closing), arm_B /= static_cast<float>(closing);
  return true;
}

bool make_approach(const Pair& pair, const Manifold& m, const Bodies& bodies, const Shapes& shapes,
                   const StepContext& step, SpeculativeContact& approach) {
  Vec3f arm_A, arm_B;
  float separation = 0;
  if (!closing_middle(m, bodies, step, arm_A, arm_B, separation)) return false;
  approach.speed_m_s = closing_speed(m, bodies, arm_A, arm_B);
  const double inverse = inverse_effective_mass(bodies, m.body_a, arm_A, m.normal_W) +
                         inverse_effective_mass(bodies, m.body_b, arm_B, m.normal_W);
  if (approach.speed_m_s <= 0 || inverse <= 0) return false;
  approach.effective_mass_kg = 1 / inverse;
  approach.separation_m = separation;
  approach.a = bodies.id(m.body_a), approach.b = bodies.id(m.body_b);
  approach.body_tag_a = bodies.tag[m.body_a], approach.body_tag_b = bodies.tag[m.body_b];
  approach.shape_tag_a = shapes[pair.shape_a].tag, approach.shape_tag_b = shapes[pair.shape_b].tag;
  // On the body that stands still, if one does: the impact will be there.
  const bool on_a = !bodies.awake(m.body_a) || bodies.awake(m.body_b);
  approach.point_W = on_a ? Vec3(bodies.position[m.body_a] + arm_A.cast<double>())
                          : Vec3(bodies.position[m.body_b] + arm_B.cast<double>());
  approach.normal_W = m.normal_W.cast<double>().normalized();
  return true;
}

}  // namespace

double closing_speed(const Manifold& m, const Bodies& bodies, const Vec3f& arm_A,
                     const Vec3f& arm_B) {
  const BodySlot a = m.body_a, b = m.body_b;
  const Vec3 v_a =
      bodies.velocity[a] + bodies.angular_velocity[a].cross(Vec3(arm_A.cast<double>()));
  const Vec3 v_b =
      bodies.velocity[b] + bodies.angular_velocity[b].cross(Vec3(arm_B.cast<double>()));
  return m.normal_W.cast<double>().dot(v_a - v_b);
}

const char* SpeculativeContacts::wrong_field(const Contacts& contacts, const Bodies& bodies,
                                             const Shapes& shapes) const {
  if (stale_.size() > bodies.size()) return "stale_";
  for (const Pair& pair : contacts.pairs)
    if (pair.present() && std::max(pair.body_a, pair.body_b).value >= stale_.size())
      return "stale_";
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const auto& [key, contact] = known_[i];
    if (i > 0 && known_[i - 1].first >= key) return "known_";
    if (!(contact.speed_m_s > 0 && contact.effective_mass_kg > 0)) return "known_";
    if (!(std::abs(contact.normal_W.squaredNorm() - 1) < 1e-6)) return "known_";
    if (!bodies.contains(contact.a) || !bodies.contains(contact.b)) continue;  // to be dropped
    if (stale_[BodySlot(contact.a.slot)] || stale_[BodySlot(contact.b.slot)]) continue;
    const PairSlot slot = contacts.slot(key);
    if (slot.none() || slot.value >= contacts.pairs.size()) return "known_";
    const Pair& pair = contacts.pairs[slot];
    if (pair.body_a.value != contact.a.slot || pair.body_b.value != contact.b.slot ||
        bodies.tag[pair.body_a] != contact.body_tag_a ||
        bodies.tag[pair.body_b] != contact.body_tag_b ||
        shapes[pair.shape_a].tag != contact.shape_tag_a ||
        shapes[pair.shape_b].tag != contact.shape_tag_b)
      return "known_";
  }
  return nullptr;
}

void SpeculativeContacts::invalidate_changed(const Bodies& bodies) {
  stale_.resize(bodies.size());
  for (const BodySlot body : bodies.slots()) stale_[body] |= bodies.changed[body];
}

std::vector<SpeculativeContact> SpeculativeContacts::find(const Contacts& contacts,
                                                          const Bodies& bodies,
                                                          const Shapes& shapes,
                                                          const StepContext& step) {
  constexpr std::size_t kChunk = 4096;
  invalidate_changed(bodies);
  if (std::exchange(dt_s_, step.dt_s) != step.dt_s)
    std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  std::erase_if(known_, [&](const Keyed& keyed) {
    const BodyId a = keyed.second.a, b = keyed.second.b;
    return !bodies.contains(a) || !bodies.contains(b) || stale_[BodySlot(a.slot)] ||
           stale_[BodySlot(b.slot)];
  });
  const auto find_in = [&](std::size_t begin, std::size_t end, std::vector<Keyed>& found) {
    for (std::size_t i = begin; i < end; ++i) {
      const Manifold& m = contacts.manifolds[ManifoldSlot(i)];
      if (m.count == 0 || !(stale_[m.body_a] || stale_[m.body_b])) continue;
      if (!touches_awake(m, bodies) || is_slow(m, bodies, step)) continue;
      const Pair& pair = contacts.pairs[m.pair];
      SpeculativeContact approach;
      if (make_approach(pair, m, bodies, shapes, step, approach))
        found.emplace_back(pair.key(), approach);
    }
  };
  auto fresh = collect_chunks<Keyed>(contacts.manifolds.size(), kChunk, find_in);
  const auto by_key = [](const Keyed& a, const Keyed& b) { return a.first < b.first; };
  std::sort(fresh.begin(), fresh.end(), by_key);
  const auto kept = static_cast<std::ptrdiff_t>(known_.size());
  known_.insert(known_.end(), fresh.begin(), fresh.end());
  std::inplace_merge(known_.begin(), known_.begin() + kept, known_.end(), by_key);
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{0});
  std::vector<SpeculativeContact> speculative_contacts;
  speculative_contacts.reserve(known_.size());
  for (const Keyed& keyed : known_) speculative_contacts.push_back(keyed.second);
  return speculative_contacts;
}

ContactsOfBodies::ContactsOfBodies(const Contacts& contacts, const Bodies& bodies)
    : first_(bodies.size() + 1, 0) {
  const auto visit = [&](auto&& use) {
    for (const ManifoldSlot i : contacts.manifolds.slots()) {
      const Manifold& m = contacts.manifolds[i];
      if (m.count == 0) continue;
      if (bodies.dynamic(m.body_a)) use(m.body_a, i);
      if (bodies.dynamic(m.body_b)) use(m.body_b, i);
    }
  };
  visit([&](BodySlot body, ManifoldSlot) { ++first_[body.value + 1]; });
  for (std::size_t body = 0; body < bodies.size(); ++body) first_[body + 1] += first_[body];
  manifolds_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  visit([&](BodySlot body, ManifoldSlot m) { manifolds_[next[body.value]++] = m; });
}

namespace {

/// Returns the manifolds of any of these bodies, by pair key.
std::vector<std::pair<std::uint64_t, ManifoldSlot>> manifolds_of(
    const Contacts& contacts, const Bodies& bodies, const ContactsOfBodies& contacts_of_bodies,
    std::span<const BodyId> of) {
  std::vector<std::pair<std::uint64_t, ManifoldSlot>> found;
  for (const BodyId id : of)
    for (const ManifoldSlot i : contacts_of_bodies.of(bodies.slot(id)))
      found.emplace_back(contacts.pairs[contacts.manifolds[i].pair].key(), i);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

std::vector<TouchingBodies> find_touching(const Contacts& contacts, const Bodies& bodies,
                                          const ContactsOfBodies& contacts_of_bodies,
                                          std::span<const BodyId> of) {
  std::vector<TouchingBodies> touching;
  for (const auto& [key, i] : manifolds_of(contacts, bodies, contacts_of_bodies, of)) {
    const Manifold& m = contacts.manifolds[i];
    const TouchingBodies both{bodies.tag[m.body_a], bodies.tag[m.body_b]};
    if (touching.empty() || touching.back() != both) touching.push_back(both);
  }
  return touching;
}

std::vector<Touch> find_touches(const Contacts& contacts, const Bodies& bodies,
                                const Shapes& shapes, const ContactsOfBodies& contacts_of_bodies,
                                std::span<const BodyId> of) {
  const auto found = manifolds_of(contacts, bodies, contacts_of_bodies, of);
  std::vector<Touch> touches;
  touches.reserve(3 * found.size());
  for (const auto& [key, i] : found) {
    const Manifold& m = contacts.manifolds[i];
    const Pair& pair = contacts.pairs[m.pair];
    Touch touch;
    touch.body_tag_a = bodies.tag[m.body_a], touch.body_tag_b = bodies.tag[m.body_b];
    touch.shape_tag_a = shapes[pair.shape_a].tag, touch.shape_tag_b = shapes[pair.shape_b].tag;
    touch.normal_W = m.normal_W.cast<double>().normalized();
    for (std::size_t p = 0; p < m.count; ++p) {
      touch.arm_a_W = m.points[p].arm_A.cast<double>();
      touch.arm_b_W = m.points[p].arm_B.cast<double>();
      touch.separation_m = double{m.points[p].separation_m};
      touches.push_back(touch);
    }
  }
  return touches;
}

}  // namespace sunder::solver
