// The part of BreakProbe behind loads(): impact loads on breakable bodies in an event.
#include <algorithm>
#include <map>
#include <utility>

#include "engine/world/break/break_probe.h"
#include "engine/world/break/even_load.h"

namespace sunder {

/// Returns the undecided body to which the work at a contact is attributed: the one with the
/// smaller least_J if both are undecided.
std::uint32_t BreakProbe::body_to_load(const ProbeContact& c) const {
  if (!undecided_[c.a]) return c.b;
  if (!undecided_[c.b]) return c.a;
  const ProbeBody &a = bodies_[c.a], &b = bodies_[c.b];
  return std::pair(a.least_J, a.key) < std::pair(b.least_J, b.key) ? c.a : c.b;
}

std::vector<ProbeLoad> BreakProbe::loads(const ClusterMotion& without) const {
  std::vector<ProbeLoad> all(bodies_.size());
  std::vector<double> most(bodies_.size(), 0), flux(bodies_.size(), 0),
      most_flux(bodies_.size(), 0);
  for (std::uint32_t b = 0; b < all.size(); ++b) all[b].body = b;
  for (ProbeLoad& load : all) load.direction_W.setZero();
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ProbeContact& c = contacts_[closed_[i]];
    const double impulse = with_->impulses_Ns[i];
    const ContactRow& row = rows_[closed_[i]];
    if (impulse <= 0 || !row.touches(undecided_)) continue;
    const std::uint32_t body = body_to_load(c);
    ProbeLoad& load = all[body];
    load.work_J += 0.5 * impulse * (row.speed(without.velocities) + row.speed(with_->velocities));
    load.impulse_Ns += impulse;
    load.arm_W += impulse * (body == c.b ? c.arm_b_W : c.arm_a_W);
    load.direction_W += (body == c.b ? impulse : -impulse) * c.normal_W;
    const double speed = std::max(0.0, row.speed(without.velocities));
    load.speed_m_s += impulse * speed * speed;
    flux[body] += impulse * speed;
    if (impulse * speed > most_flux[body]) {
      most_flux[body] = impulse * speed;
      load.striker = body == c.b ? c.a : c.b;
    }
    if (impulse <= most[body]) continue;
    most[body] = impulse;
    load.shape = body == c.b ? c.shape_b : c.shape_a;
  }
  for (ProbeLoad& load : all)
    if (flux[load.body] > 0) load.speed_m_s /= flux[load.body];
  std::erase_if(all, [&](const ProbeLoad& load) {
    const ProbeBody& body = bodies_[load.body];
    return body.withstands(load.work_J, load.impulse_Ns, load.speed_m_s) ||
           load.direction_W.squaredNorm() <= 0;
  });
  for (ProbeLoad& load : all) {
    load.arm_W /= load.impulse_Ns;
    load.direction_W.normalize();
    add_contact_impulses(load);
  }
  return all;
}

/// Adds the impulses of contacts to a load, those of each other body distributed as evenly as their
/// sum and moment allow.
void BreakProbe::add_contact_impulses(ProbeLoad& load) const {
  std::map<std::uint32_t, std::vector<PressedPoint>> by_body;
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ProbeContact& c = contacts_[closed_[i]];
    const double impulse = with_->impulses_Ns[i];
    const auto add = [&](std::uint32_t other, std::uint32_t shape, const Vec3& arm_W, double sign) {
      by_body[other].push_back(
          {c.rope ? ProbeImpulse::kNearestShape : shape, arm_W, sign * c.normal_W, impulse});
    };
    if (c.a == load.body) add(c.b, c.shape_a, c.arm_a_W, -1);
    if (c.b == load.body) add(c.a, c.shape_b, c.arm_b_W, 1);
  }
  for (auto& [other, points] : by_body) {
    spread_evenly(points);
    for (const PressedPoint& point : points) {
      if (point.impulse_Ns <= 0) continue;
      load.impulses.push_back({point.shape, point.arm_W, point.impulse_Ns * point.along_W});
    }
  }
  add_joint_impulses(load);
}

/// Adds the impulses of joints to a load: the body's change of momentum less the contact impulses,
/// in equal shares for all joints of the body.
void BreakProbe::add_joint_impulses(ProbeLoad& load) const {
  const ProbeBody& body = bodies_[load.body];
  std::vector<Vec3> arms_W;
  for (const ProbeJoint& joint : joints_) {
    if (joint.a == load.body) arms_W.push_back(joint.arm_a_W);
    if (joint.b == load.body) arms_W.push_back(joint.arm_b_W);
  }
  if (arms_W.empty() || body.inverse_mass <= 0) return;
  const BodyVelocity &after = with_->velocities[load.body], &before = velocities_[load.body];
  Vec3 linear = (after.linear - before.linear) / body.inverse_mass;
  Vec3 angular = body.inverse_inertia_W.inverse() * (after.angular - before.angular);
  for (const ProbeImpulse& impulse : load.impulses) {
    linear -= impulse.impulse_W;
    angular -= impulse.arm_W.cross(impulse.impulse_W);
  }
  const double share = 1 / static_cast<double>(arms_W.size());
  for (const Vec3& arm_W : arms_W) angular -= share * arm_W.cross(linear);
  for (const Vec3& arm_W : arms_W)
    load.impulses.push_back({ProbeImpulse::kNearestShape, arm_W, share * linear, share * angular});
}

}  // namespace sunder
