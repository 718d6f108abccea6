#include "solver/rigid/impulse_reach.h"

#include <algorithm>
#include <utility>

#include "engine/base/parallel.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// True if a point that closes may bear an impulse within the step. Rounding and gravity may close
/// a gap that the closing speed alone leaves open.
bool may_meet(const StepContext& step, const Manifold& m, const ManifoldPoint& point,
              double speed_m_s) {
  return double{point.separation_m} <= step.dt_s * speed_m_s + double{kContactMargin * m.size_m};
}

/// Change of a body's velocity.
struct Motion6 {
  Vec3 linear, angular;

  Vec3 at(const Vec3& arm_W) const { return linear + angular.cross(arm_W); }
};

/// Finds hits and the bodies that they reach.
class Reach {
 public:
  Reach(const StepContext& step, std::vector<Hit> hits, const Contacts& contacts,
        const ContactsOfBodies& contacts_of_bodies, const Joints& joints, const Bodies& bodies)
      : step_(step),
        contacts_(contacts),
        contacts_of_bodies_(contacts_of_bodies),
        joints_(joints),
        bodies_(bodies),
        visited_(bodies.size(), 0) {
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
      group_kg_.push_back(hits[i].mass_kg);
      waiting_.push_back({hits[i], i});
    }
    std::ranges::make_heap(waiting_, is_slower);
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
      if (!joints[i].holds()) continue;
      for (const BodySlot body : {joints[i].body_a, joints[i].body_b})
        if (!body.none()) joints_of_.emplace_back(body, i);
    }
    std::ranges::sort(joints_of_);
  }

  std::vector<BodySlot> run() {
    while (!waiting_.empty()) {
      std::ranges::pop_heap(waiting_, is_slower);
      const Waiting next = waiting_.back();
      waiting_.pop_back();
      visit(next);
    }
    return std::move(reached_);
  }

 private:
  struct Waiting {
    Hit hit;
    std::uint32_t group;  ///< Index of the first hit.
  };
  /// The fastest hit is visited first; of equal ones, that on the lowest slot.
  static bool is_slower(const Waiting& x, const Waiting& y) {
    return std::pair(x.hit.speed_m_s, y.hit.body) < std::pair(y.hit.speed_m_s, x.hit.body);
  }

  void visit(const Waiting& at) {
    const BodySlot body = at.hit.body;
    if (visited_[body]) return;
    double& group_kg = group_kg_[at.group];
    // Others of the group that were reached since share the momentum.
    const double speed_m_s = at.hit.speed_m_s * at.hit.mass_kg / group_kg;
    if (speed_m_s < passed_m_s(body)) return;
    visited_[body] = 1;
    if (!bodies_.awake(body)) reached_.push_back(body);
    const Motion6 motion = struck(at.hit, speed_m_s, group_kg);
    group_kg += bodies_.mass_kg[body];
    pass_on(at, motion, group_kg);
  }

  double passed_m_s(BodySlot body) const {
    return kPassedSpeed * step_.froude.speed_m_s(bodies_.reach_m[body]);
  }

  /// Returns the change of velocity of a body that a mass strikes, after which the place of the
  /// impact has one speed on both.
  Motion6 struck(const Hit& hit, double speed_m_s, double mass_kg) const {
    const Mat3 root_W = (bodies_.rotation_f[hit.body] * bodies_.root_B[hit.body]).cast<double>();
    const Vec3 turn = root_W.transpose() * hit.arm_W.cross(hit.direction_W);
    const double inverse_kg = 1 / bodies_.mass_kg[hit.body];
    const double impulse_Ns = speed_m_s / (1 / mass_kg + inverse_kg + turn.squaredNorm());
    return {impulse_Ns * inverse_kg * hit.direction_W, impulse_Ns * (root_W * turn)};
  }

  void pass_on(const Waiting& from, Motion6 motion, double group_kg) {
    const BodySlot body = from.hit.body;
    const auto contacts = contacts_of_bodies_.of(body);
    const auto each = [&](const auto& visit) {
      for (const ManifoldSlot slot : contacts) {
        if (slot == from.hit.manifold) continue;
        const Manifold& m = contacts_.manifolds[slot];
        const bool on_b = m.body_b != body;
        visit(slot, m, on_b ? m.body_b : m.body_a, on_b, on_b ? 1. : -1.);
      }
    };
    // An immovable body bears what is pressed on it.
    each([&](ManifoldSlot, const Manifold& m, BodySlot other, bool, double sign) {
      if (bodies_.dynamic(other)) return;
      const Vec3 normal = sign * m.normal_W.cast<double>();
      motion.linear -= std::max(0., normal.dot(motion.linear)) * normal;
    });
    each([&](ManifoldSlot slot, const Manifold& m, BodySlot other, bool on_b, double sign) {
      if (!bodies_.dynamic(other) || visited_[other]) return;
      const Vec3 normal = sign * m.normal_W.cast<double>();
      Waiting next{{other, slot, Vec3::Zero(), normal, 0, group_kg}, from.group};
      for (std::size_t i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[i];
        const Vec3 own = (on_b ? p.arm_A : p.arm_B).cast<double>();
        const double speed = normal.dot(motion.at(own));
        if (speed <= next.hit.speed_m_s || !may_meet(step_, m, p, speed)) continue;
        next.hit.speed_m_s = speed;
        next.hit.arm_W = (on_b ? p.arm_B : p.arm_A).cast<double>();
      }
      push(next);
    });
    const auto [first, last] =
        std::ranges::equal_range(joints_of_, body, {}, &std::pair<BodySlot, std::uint32_t>::first);
    for (auto it = first; it != last; ++it) {
      const Joint& joint = joints_[it->second];
      const bool on_b = joint.body_b != body;
      const BodySlot other = on_b ? joint.body_b : joint.body_a;
      if (other.none() || !bodies_.dynamic(other) || visited_[other]) continue;
      const auto arm = [&](BodySlot of, const Vec3& anchor_R) {
        return Vec3(bodies_.rotation[of] * (anchor_R - bodies_.com_R[of]));
      };
      const Vec3& own_R = on_b ? joint.desc.anchor_a_R : joint.desc.anchor_b_R;
      const Vec3& other_R = on_b ? joint.desc.anchor_b_R : joint.desc.anchor_a_R;
      const Vec3 velocity = motion.at(arm(body, own_R));
      const double speed = velocity.norm();
      if (!(speed > 0)) continue;
      push({{other, {}, arm(other, other_R), velocity / speed, speed, group_kg}, from.group});
    }
  }

  void push(const Waiting& next) {
    if (next.hit.speed_m_s < passed_m_s(next.hit.body)) return;
    waiting_.push_back(next);
    std::ranges::push_heap(waiting_, is_slower);
  }

  const StepContext& step_;
  const Contacts& contacts_;
  const ContactsOfBodies& contacts_of_bodies_;
  const Joints& joints_;
  const Bodies& bodies_;
  ByBody<std::uint8_t> visited_;
  std::vector<double> group_kg_;  ///< Mass that a hit has set in motion, by group.
  std::vector<Waiting> waiting_;  ///< A heap.
  std::vector<std::pair<BodySlot, std::uint32_t>> joints_of_;
  std::vector<BodySlot> reached_;
};

}  // namespace

double least_hit_m_s(const StepContext& step, double reach_m) {
  return std::max(kHitSpeed * step.froude.speed_m_s(reach_m),
                  step.froude.gravity_m_s2() * step.dt_s);
}

std::vector<Hit> find_hits(const StepContext& step, const Contacts& contacts,
                           const Bodies& bodies) {
  constexpr std::size_t kChunk = 1024;
  const std::size_t all = contacts.manifolds.size();
  std::vector<std::uint8_t> borders((all + kChunk - 1) / kChunk, 0);
  std::vector<std::vector<Hit>> found(borders.size());
  for_chunks(all, kChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    for (ManifoldSlot slot(begin); slot.value < end; ++slot.value) {
      const Manifold& m = contacts.manifolds[slot];
      if (!touches_awake(m, bodies) || !bodies.dynamic(m.body_a) || !bodies.dynamic(m.body_b))
        continue;
      const bool a_sleeps = !bodies.awake(m.body_a), b_sleeps = !bodies.awake(m.body_b);
      if (a_sleeps || b_sleeps) borders[c] = 1;
      const Vec3 normal = m.normal_W.cast<double>();
      Hit on_b{m.body_b, slot, Vec3::Zero(), normal, 0, bodies.mass_kg[m.body_a]};
      Hit on_a{m.body_a, slot, Vec3::Zero(), -normal, 0, bodies.mass_kg[m.body_b]};
      for (std::size_t i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[i];
        const double speed = closing_speed(m, bodies, p.arm_A, p.arm_B);
        if (speed <= on_b.speed_m_s || !may_meet(step, m, p, speed)) continue;
        on_a.speed_m_s = on_b.speed_m_s = speed;
        on_a.arm_W = p.arm_A.cast<double>(), on_b.arm_W = p.arm_B.cast<double>();
      }
      const auto is_hit = [&](const Hit& hit) {
        return hit.speed_m_s >= least_hit_m_s(step, bodies.reach_m[hit.body]);
      };
      if (!b_sleeps || a_sleeps)
        if (is_hit(on_a)) found[c].push_back(on_a);
      if (!a_sleeps || b_sleeps)
        if (is_hit(on_b)) found[c].push_back(on_b);
    }
  });
  std::vector<Hit> hits;
  if (std::ranges::find(borders, 1) == borders.end()) return hits;
  for (const std::vector<Hit>& chunk : found) hits.insert(hits.end(), chunk.begin(), chunk.end());
  return hits;
}

std::vector<BodySlot> find_reached(const StepContext& step, std::vector<Hit> hits,
                                   const Contacts& contacts,
                                   const ContactsOfBodies& contacts_of_bodies, const Joints& joints,
                                   const Bodies& bodies) {
  return Reach(step, std::move(hits), contacts, contacts_of_bodies, joints, bodies).run();
}

}  // namespace sunder::solver
