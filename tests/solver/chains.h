// Test fixture: chains of boxes in joints, with a ball at the end.
#pragma once

#include <vector>

#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {

/// Returns the distance between the two anchors of a joint, in m.
inline double gap(const RigidWorld& world, const JointDesc& joint) {
  const Vec3 a = joint.a.none() ? joint.anchor_a_R : world.state(joint.a).X_WB * joint.anchor_a_R;
  const Vec3 b = joint.b.none() ? joint.anchor_b_R : world.state(joint.b).X_WB * joint.anchor_b_R;
  return (b - a).norm();
}

/// Returns the body with a sphere of 1 mm as its only shape, so that it hardly ever collides.
inline BodyDesc with_tiny_shape(BodyDesc body) {
  ShapeDesc point;
  point.kind = ShapeDesc::Kind::kSphere;
  point.radius_m = 1e-3;
  body.shapes = {point};
  return body;
}

/// A chain of links along a direction, with a ball at its end as the last body.
struct Chain {
  std::vector<BodyId> bodies;
  std::vector<JointDesc> joints;
  double length_m = 0;

  /// Returns the sum of the gaps at the joints as a fraction of the chain's length.
  double stretch(const RigidWorld& world) const {
    double sum = 0;
    for (const JointDesc& joint : joints) sum += gap(world, joint);
    return sum / length_m;
  }
};

struct ChainDesc {
  int links = 20;
  double ball_ratio = 1;  ///< Mass of the ball over that of a link.
  Vec3 along = Vec3::UnitX();
  JointDesc::Kind kind = JointDesc::Kind::kBall;
  bool hangs = true;  ///< True if the chain hangs from the origin; false if it is free and collides
                      ///< with nothing.
  int stride = 1;     ///< The k-th joint created is number k·stride modulo (links + 1).
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
    chain.bodies.push_back(world.add(desc.hangs ? body : with_tiny_shape(body)));
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
