#include "engine/world/actors/joints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/actors/actors.h"

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

void lose(World& world, std::vector<LiveJoint>::iterator joint) {
  world.physics->cut(joint->id);
  world.joints.erase(joint);
  ++world.report.joints_lost;
}

}  // namespace

void add_joint(World& world, const Joint& joint) {
  LiveJoint live;
  JointDesc desc;
  desc.kind = joint.kind;
  live.rigid = joint.kind == JointDesc::Kind::kFixed;
  const bool apart =
      joint.kind == JointDesc::Kind::kDistance || joint.kind == JointDesc::Kind::kRope;
  const Vec3 end_W = apart ? joint.to_W : joint.at_W;
  Quat rotation_WR[2];
  const auto set_end = [&](std::optional<std::uint32_t> key, const Vec3& anchor_W, JointEnd& end,
                           BodyId& body, Vec3& anchor_R, Vec3& axis_R, Quat& q) {
    end = {key.value_or(kGroundKey), anchor_W};
    Pose X_WR;
    if (key) {
      const Actor& actor = *world.find(*key);
      const Pose X_WB = world.physics->state(actor.body).X_WB;
      X_WR = {X_WB * Vec3(-actor.weight.com_R), X_WB.rotation};
      body = actor.body;
    }
    anchor_R = end.anchor_R = X_WR.inverse() * anchor_W;
    axis_R = X_WR.rotation.conjugate() * joint.axis_W.normalized();
    q = X_WR.rotation;
  };
  set_end(joint.a, joint.at_W, live.a, desc.a, desc.anchor_a_R, desc.axis_a_R, rotation_WR[0]);
  set_end(joint.b, end_W, live.b, desc.b, desc.anchor_b_R, desc.axis_b_R, rotation_WR[1]);
  desc.rotation_RaRb = rotation_WR[0].conjugate() * rotation_WR[1];
  desc.length_m = (end_W - joint.at_W).norm();
  desc.breaking_N = joint.breaking_N;
  desc.breaking_Nm = joint.breaking_Nm;
  desc.collide = joint.collide;
  live.id = world.physics->join(desc);
  world.joints.push_back(live);
}

void hang(World& world, const Shot& shot) {
  std::optional<std::uint32_t> above;
  Joint joint;
  if (shot.links.empty()) {
    add_ball(world, shot.ball);
    joint.kind = JointDesc::Kind::kRope;
    joint.at_W = *shot.hangs_from_W;
    joint.to_W = shot.ball.center_W;
  } else {
    const Vec3 way = shot.ball.center_W - *shot.hangs_from_W;
    const Vec3 chain = way - shot.ball.radius_m * way.normalized();
    const double count = static_cast<double>(shot.links.size());
    for (std::size_t i = 0; i < shot.links.size(); ++i) {
      add_compounds(world, std::span(&shot.links[i], 1));
      joint.a = above;
      joint.b = above = world.actors.back().key;
      joint.at_W = *shot.hangs_from_W + static_cast<double>(i) / count * chain;
      add_joint(world, joint);
    }
    add_ball(world, shot.ball);
    joint.at_W = *shot.hangs_from_W + chain;
  }
  joint.a = above;
  joint.b = world.actors.back().key;
  add_joint(world, joint);
}

void move_joints(World& world, const Actor& parent, bool stays, std::span<const Actor> pieces) {
  std::vector<const Actor*> actors;
  if (stays) actors.push_back(&parent);
  for (const Actor& piece : pieces) actors.push_back(&piece);
  for (auto joint = world.joints.begin(); joint != world.joints.end();) {
    bool whole = true;
    for (JointEnd* end : {&joint->a, &joint->b}) {
      if (end->key != parent.key) continue;
      const Actor* actor = actor_at(actors, end->anchor_R);
      whole = whole && actor;
      if (!actor || actor == &parent) continue;
      end->key = actor->key;
      world.physics->attach(joint->id, end == &joint->a, actor->body);
    }
    if (whole) {
      ++joint;
      continue;
    }
    const std::ptrdiff_t at = joint - world.joints.begin();
    lose(world, joint);
    joint = world.joints.begin() + at;
  }
}

void cut_joints(World& world, std::uint32_t key) {
  for (std::size_t i = world.joints.size(); i-- > 0;) {
    const auto joint = world.joints.begin() + static_cast<std::ptrdiff_t>(i);
    if (joint->a.key == key || joint->b.key == key) lose(world, joint);
  }
}

void note_broken_joints(World& world) {
  if (world.joints.empty()) return;
  for (const JointId joint : world.physics->take_broken()) {
    std::erase_if(world.joints, [&](const LiveJoint& live) { return live.id == joint; });
    ++world.report.joints_lost;
  }
}

std::vector<std::uint32_t> fixed_to_world(const World& world) {
  const auto stands = [&](std::uint32_t key) {
    const auto actor = std::ranges::lower_bound(world.actors, key, {}, &Actor::key);
    return key == kGroundKey || (actor != world.actors.end() && actor->is_static);
  };
  std::vector<std::uint32_t> keys;
  for (const LiveJoint& joint : world.joints) {
    if (joint.rigid && stands(joint.b.key)) keys.push_back(joint.a.key);
    if (joint.rigid && stands(joint.a.key)) keys.push_back(joint.b.key);
  }
  std::ranges::sort(keys);
  return keys;
}

}  // namespace sunder
