#include "engine/world/actors/joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sunder {
namespace {

constexpr double kReach = 0.02;  // of a piece's size: an anchor so far off it is still its own

/// The actor that has a point, or is nearest within reach; null if none.
const Actor* actor_at(std::span<const Actor* const> actors, const Vec3& point_R) {
  const Actor* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Actor* actor : actors) {
    const double distance = distance_outside(actor->structure, point_R);
    if (distance >= least || distance > kReach * std::cbrt(actor->volume_m3)) continue;
    least = distance;
    nearest = actor;
  }
  return nearest;
}

}  // namespace

void Joints::add(Physics& physics, const Actors& actors, const Joint& joint) {
  Live live;
  JointDesc desc;
  desc.kind = joint.kind;
  live.kind = joint.kind;
  const bool apart =
      joint.kind == JointDesc::Kind::kDistance || joint.kind == JointDesc::Kind::kRope;
  const Vec3 end_W = apart ? joint.to_W : joint.at_W;
  Quat rotation_WR[2];
  const auto set_end = [&](std::optional<std::uint32_t> key, const Vec3& anchor_W, End& end,
                           BodyId& body, Vec3& anchor_R, Vec3& axis_R, Quat& q) {
    end = {key.value_or(kGroundKey), anchor_W};
    Pose X_WR;
    if (key) {
      const Actor& actor = *actors.find(*key);
      X_WR = rest_pose(actor, physics.state(actor.body).X_WB);
      body = actor.body;
    }
    anchor_R = end.anchor_R = X_WR.inverse() * anchor_W;
    axis_R = X_WR.rotation.conjugate() * joint.axis_W.normalized();
    q = X_WR.rotation;
  };
  set_end(joint.a, joint.at_W, live.a, desc.a, desc.anchor_a_R, desc.axis_a_R, rotation_WR[0]);
  set_end(joint.b, end_W, live.b, desc.b, desc.anchor_b_R, desc.axis_b_R, rotation_WR[1]);
  desc.rotation_RaRb = rotation_WR[0].conjugate() * rotation_WR[1];
  live.axis_a_R = desc.axis_a_R;
  live.length_m = desc.length_m = (end_W - joint.at_W).norm();
  desc.breaking_N = joint.breaking_N;
  desc.breaking_Nm = joint.breaking_Nm;
  desc.collide = joint.collide;
  live.id = physics.join(desc);
  live_.push_back(live);
}

std::uint32_t Joints::follow(Physics& physics, const Actor& parent, bool stays,
                             std::span<const Actor> pieces) {
  std::vector<const Actor*> actors;
  if (stays) actors.push_back(&parent);
  for (const Actor& piece : pieces) actors.push_back(&piece);
  std::vector<JointId> lost;
  for (Live& joint : live_) {
    bool whole = true;
    for (End* end : {&joint.a, &joint.b}) {
      if (end->key != parent.key) continue;
      const Actor* actor = actor_at(actors, end->anchor_R);
      whole = whole && actor;
      if (!actor || actor == &parent) continue;
      end->key = actor->key;
      physics.attach(joint.id, end == &joint.a, actor->body);
    }
    if (whole) continue;
    physics.cut(joint.id);
    lost.push_back(joint.id);
  }
  return forget(lost);
}

std::uint32_t Joints::cut(Physics& physics, std::uint32_t key) {
  std::vector<JointId> lost;
  for (auto joint = live_.rbegin(); joint != live_.rend(); ++joint) {
    if (joint->a.key != key && joint->b.key != key) continue;
    physics.cut(joint->id);
    lost.push_back(joint->id);
  }
  return forget(lost);
}

std::uint32_t Joints::take_broken(Physics& physics) {
  return live_.empty() ? 0 : forget(physics.take_broken());
}

/// Returns how many.
std::uint32_t Joints::forget(const std::vector<JointId>& gone) {
  for (const JointId id : gone) {
    std::erase_if(live_, [&](const Live& joint) { return joint.id == id; });
  }
  return static_cast<std::uint32_t>(gone.size());
}

}  // namespace sunder
