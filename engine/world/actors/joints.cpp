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

void lose(World& world, std::vector<HeldTie>::iterator tie) {
  world.physics->cut(tie->joint);
  world.ties.erase(tie);
  ++world.report.joints_lost;
}

}  // namespace

void add_tie(World& world, const Tie& tie) {
  HeldTie held;
  JointDesc joint;
  joint.kind = tie.kind;
  held.rigid = tie.kind == JointDesc::Kind::kFixed;
  const bool apart = tie.kind == JointDesc::Kind::kDistance || tie.kind == JointDesc::Kind::kRope;
  const Vec3 end_W = apart ? tie.to_W : tie.at_W;
  Quat rotation_WR[2];
  const auto set_end = [&](std::optional<std::uint32_t> key, const Vec3& anchor_W, TieEnd& end,
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
    axis_R = X_WR.rotation.conjugate() * tie.axis_W.normalized();
    q = X_WR.rotation;
  };
  set_end(tie.a, tie.at_W, held.a, joint.a, joint.anchor_a_R, joint.axis_a_R, rotation_WR[0]);
  set_end(tie.b, end_W, held.b, joint.b, joint.anchor_b_R, joint.axis_b_R, rotation_WR[1]);
  joint.rotation_RaRb = rotation_WR[0].conjugate() * rotation_WR[1];
  joint.length_m = (end_W - tie.at_W).norm();
  joint.breaking_N = tie.breaking_N;
  joint.breaking_Nm = tie.breaking_Nm;
  joint.collide = tie.collide;
  held.joint = world.physics->join(joint);
  world.ties.push_back(held);
}

void hang(World& world, const Shot& shot) {
  std::optional<std::uint32_t> above;
  Tie tie;
  if (shot.links.empty()) {
    add_ball(world, shot.ball);
    tie.kind = JointDesc::Kind::kRope;
    tie.at_W = *shot.hangs_from_W;
    tie.to_W = shot.ball.center_W;
  } else {
    const Vec3 way = shot.ball.center_W - *shot.hangs_from_W;
    const Vec3 chain = way - shot.ball.radius_m * way.normalized();
    const double count = static_cast<double>(shot.links.size());
    for (std::size_t i = 0; i < shot.links.size(); ++i) {
      add_compounds(world, std::span(&shot.links[i], 1));
      tie.a = above;
      tie.b = above = world.actors.back().key;
      tie.at_W = *shot.hangs_from_W + static_cast<double>(i) / count * chain;
      add_tie(world, tie);
    }
    add_ball(world, shot.ball);
    tie.at_W = *shot.hangs_from_W + chain;
  }
  tie.a = above;
  tie.b = world.actors.back().key;
  add_tie(world, tie);
}

void move_ties(World& world, const Actor& parent, bool stays, std::span<const Actor> pieces) {
  std::vector<const Actor*> actors;
  if (stays) actors.push_back(&parent);
  for (const Actor& piece : pieces) actors.push_back(&piece);
  for (auto tie = world.ties.begin(); tie != world.ties.end();) {
    bool held = true;
    for (TieEnd* end : {&tie->a, &tie->b}) {
      if (end->key != parent.key) continue;
      const Actor* actor = actor_at(actors, end->anchor_R);
      held = held && actor;
      if (!actor || actor == &parent) continue;
      end->key = actor->key;
      world.physics->attach(tie->joint, end == &tie->a, actor->body);
    }
    if (held) {
      ++tie;
      continue;
    }
    const std::ptrdiff_t at = tie - world.ties.begin();
    lose(world, tie);
    tie = world.ties.begin() + at;
  }
}

void cut_ties(World& world, std::uint32_t key) {
  for (std::size_t i = world.ties.size(); i-- > 0;) {
    const auto tie = world.ties.begin() + static_cast<std::ptrdiff_t>(i);
    if (tie->a.key == key || tie->b.key == key) lose(world, tie);
  }
}

void note_broken_ties(World& world) {
  if (world.ties.empty()) return;
  for (const JointId joint : world.physics->take_broken()) {
    std::erase_if(world.ties, [&](const HeldTie& tie) { return tie.joint == joint; });
    ++world.report.joints_lost;
  }
}

std::vector<std::uint32_t> fixed_to_world(const World& world) {
  const auto stands = [&](std::uint32_t key) {
    const auto actor = std::ranges::lower_bound(world.actors, key, {}, &Actor::key);
    return key == kGroundKey || (actor != world.actors.end() && actor->is_static);
  };
  std::vector<std::uint32_t> keys;
  for (const HeldTie& tie : world.ties) {
    if (tie.rigid && stands(tie.b.key)) keys.push_back(tie.a.key);
    if (tie.rigid && stands(tie.a.key)) keys.push_back(tie.b.key);
  }
  std::ranges::sort(keys);
  return keys;
}

}  // namespace sunder
