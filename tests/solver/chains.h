// Chains of links.
#pragma once

#include <vector>

#include "bench/truths/rigid_world.h"

namespace sunder::solver {

/// How far the ends of a joint are apart.
inline double gap(const RigidWorld& world, const JointDesc& joint) {
  const Vec3 a = joint.a.none() ? joint.anchor_a_R : world.state(joint.a).X_WB * joint.anchor_a_R;
  const Vec3 b = joint.b.none() ? joint.anchor_b_R : world.state(joint.b).X_WB * joint.anchor_b_R;
  return (b - a).norm();
}

/// As it was, but it hardly ever touches anything.
inline BodyDesc slender(BodyDesc body) {
  ShapeDesc point;
  point.kind = ShapeDesc::Kind::kSphere;
  point.radius_m = 1e-3;
  body.shapes = {point};
  return body;
}

/// A chain of links along a direction, with a ball of so many times a link's weight at its end;
/// the ball last.
struct Chain {
  std::vector<BodyId> bodies;
  std::vector<JointDesc> joints;
  double length_m = 0;

  /// Of its length, by what its joints are apart.
  double stretch(const RigidWorld& world) const {
    double sum = 0;
    for (const JointDesc& joint : joints) sum += gap(world, joint);
    return sum / length_m;
  }
};

struct ChainDesc {
  int links = 20;
  double ball_ratio = 1;
  Vec3 along = Vec3::UnitX();
  JointDesc::Kind kind = JointDesc::Kind::kBall;
  bool hangs = true;  ///< From the origin; or else it is free, and touches nothing.
  int stride = 1;     ///< Joints are made in steps of so many, around and around.
};

inline Chain add_chain(RigidWorld& world, const ChainDesc& desc) {
  using W = RigidWorld;
  Chain chain;
  const double pitch = 0.2, radius = 0.3;
  const BodyDesc link = W::box(Vec3(pitch, 0.05, 0.05), Vec3::Zero());
  for (int i = 0; i <= desc.links; ++i) {
    const bool ball = i == desc.links;
    BodyDesc body = link;
    if (ball)
      body = W::sphere(radius, Vec3::Zero(),
                       desc.ball_ratio * link.mass_kg / W::sphere(radius, Vec3::Zero(), 1).mass_kg);
    body.X_WB.position = (pitch * i + (ball ? radius : 0.5 * pitch)) * desc.along;
    body.X_WB.rotation = Quat::FromTwoVectors(Vec3::UnitX(), desc.along);
    chain.bodies.push_back(world.add(desc.hangs ? body : slender(body)));
  }
  for (int k = 0; k <= desc.links; ++k) {
    const int i = k * desc.stride % (desc.links + 1);
    if (i == 0 && !desc.hangs) continue;
    const BodyId above = i == 0 ? BodyId() : chain.bodies[static_cast<std::size_t>(i) - 1];
    chain.joints.push_back(joint_at(world, desc.kind, above,
                                    chain.bodies[static_cast<std::size_t>(i)],
                                    pitch * i * desc.along));
    world.physics().join(chain.joints.back());
  }
  chain.length_m = pitch * desc.links;
  return chain;
}

}  // namespace sunder::solver
