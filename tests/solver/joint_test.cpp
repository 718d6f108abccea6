// Tests of joints against closed forms, and of their loads, momentum, sleep and determinism.
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/presets.h"
#include "tests/solver/chains.h"

namespace sunder::solver::joint_test {
namespace {

using W = RigidWorld;
using Kind = JointDesc::Kind;
// Step and substeps of the preset `accurate`.
constexpr double kDt_s = 1.0 / 120;
constexpr int kSubsteps = 8;

TEST(Joint, AHingeKeepsItsAxis) {
  RigidWorld world(awake());
  const BodyId door = world.add(W::box(Vec3(1, 2, 0.1), Vec3(0.5, 0, 0)));
  const JointDesc joint = joint_at(world, Kind::kHinge, {}, door, Vec3::Zero(), Vec3::UnitY());
  world.physics().join(joint);
  const double mass = 200;
  world.physics().apply_impulse(door, Vec3(0, 0, 2 * mass), Vec3(0.7, 0.6, 0));
  double max_tilt = 0, spin_rad_s = 0;
  for (int i = 0; i < 600; ++i) {
    world.step(kDt_s, kSubsteps);
    const Vec3 axis = world.state(door).X_WB.rotation * joint.axis_b_R;
    max_tilt = std::max(max_tilt, axis.cross(Vec3::UnitY()).norm());
    EXPECT_LT(gap(world, joint), 1e-4);
    spin_rad_s = world.state(door).angular_velocity_W.y();
  }
  std::printf("hinge: axis leans by %.1e rad at most, turns at %.3f rad/s\n", max_tilt, spin_rad_s);
  EXPECT_LT(max_tilt, 1e-3);
  // ΔL about the axis is 2·m·0.7; the inertia is m (1 + 0.01)/12 + m/4.
  EXPECT_NEAR(std::abs(spin_rad_s), 1.4 / (1.01 / 12 + 0.25), 0.01 * std::abs(spin_rad_s));
}

TEST(Joint, AHingeBetweenBodiesThatTumbleKeepsItsAxis) {
  RigidWorld world(awake(Vec3::Zero()));
  const Vec3 spin(3, 20, 1);
  BodyDesc left = W::box(Vec3(0.9, 0.4, 0.3), Vec3(-0.5, 0, 0));
  BodyDesc right = W::box(Vec3(0.8, 0.3, 0.5), Vec3(0.5, 0, 0));
  for (BodyDesc* body : {&left, &right}) {
    body->velocity_W = spin.cross(body->X_WB.position);
    body->angular_velocity_W = spin;
  }
  const BodyId a = world.add(left), b = world.add(right);
  const JointDesc joint = joint_at(world, Kind::kHinge, a, b, Vec3::Zero(), Vec3::UnitZ());
  world.physics().join(joint);
  const Vec3 L = world.angular_momentum();
  const double energy = world.kinetic_energy();
  double max_tilt = 0, apart = 0;
  for (int i = 0; i < 240; ++i) {
    world.step(kDt_s, kSubsteps);
    const Vec3 axis_a = world.state(a).X_WB.rotation * joint.axis_a_R;
    const Vec3 axis_b = world.state(b).X_WB.rotation * joint.axis_b_R;
    max_tilt = std::max(max_tilt, axis_a.cross(axis_b).norm());
    apart = std::max(apart, gap(world, joint));
  }
  EXPECT_LT(max_tilt, 2e-5);
  EXPECT_LT(apart, 2e-5);
  EXPECT_LT((world.angular_momentum() - L).norm(), 1e-5 * L.norm());
  EXPECT_NEAR(world.kinetic_energy() / energy, 1, 1e-3);
}

TEST(Joint, AFixedJointIgnoresTheSignOfAQuaternion) {
  RigidWorld world(awake());
  BodyDesc box = W::box(Vec3(0.2, 0.1, 0.1), Vec3(0.1, 0, 0));
  box.X_WB.rotation = Quat(-1, 0, 0, 0);
  const BodyId id = world.add(box);
  JointDesc joint = joint_at(world, Kind::kFixed, {}, id, Vec3::Zero());
  joint.rotation_RaRb = Quat::Identity();  // The same rotation as the other quaternion.
  world.physics().join(joint);
  world.run(0.2, kDt_s, kSubsteps);
  EXPECT_LT((world.state(id).X_WB.position - Vec3(0.1, 0, 0)).norm(), 1e-4);
  EXPECT_LT(world.state(id).velocity_W.norm(), 1e-3);
}

TEST(Joint, ADoorOnTwoRedundantHingesStaysInPlace) {
  RigidWorld world(awake());
  const BodyId door = world.add(W::box(Vec3(1, 2, 0.1), Vec3(0.5, 0, 0)));
  for (const double y : {-0.8, 0.8}) {
    world.physics().join(joint_at(world, Kind::kHinge, {}, door, Vec3(0, y, 0), Vec3::UnitY()));
  }
  world.run(5, kDt_s, kSubsteps);
  EXPECT_LT((world.state(door).X_WB.position - Vec3(0.5, 0, 0)).norm(), 1e-3);
  EXPECT_LT(world.state(door).velocity_W.norm(), 1e-3);
}

TEST(Joint, ADistanceJointKeepsItsLengthAndARopeOnlyPulls) {
  for (const Kind kind : {Kind::kDistance, Kind::kRope}) {
    RigidWorld world(awake());
    BodyDesc ball = W::sphere(0.1, Vec3(0, 1, 0));
    ball.velocity_W = Vec3(1, 0, 0);
    const BodyId id = world.add(ball);
    JointDesc joint = joint_at(world, kind, {}, id, Vec3::Zero());
    joint.anchor_b_R = Vec3::Zero();
    joint.length_m = 1;
    world.physics().join(joint);
    double longest = 0, shortest = 9;
    for (int i = 0; i < 360; ++i) {
      world.step(kDt_s, kSubsteps);
      longest = std::max(longest, gap(world, joint));
      shortest = std::min(shortest, gap(world, joint));
    }
    EXPECT_NEAR(longest, 1, 2e-3);
    if (kind == Kind::kDistance) {
      EXPECT_NEAR(shortest, 1, 2e-3);
    } else {
      EXPECT_LT(shortest, 0.9);
    }
  }
}

TEST(Joint, ABallOnARopeCirclesWithoutLosingSpeed) {
  RigidWorld world(awake(Vec3::Zero()));
  BodyDesc ball = W::sphere(0.5, Vec3(3, 0, 0));
  ball.velocity_W = Vec3(0, 2, 0);
  const BodyId id = world.add(ball);
  JointDesc rope = joint_at(world, Kind::kRope, {}, id, Vec3::Zero());
  rope.anchor_b_R = Vec3::Zero();
  rope.length_m = 3;
  world.physics().join(rope);
  double farthest = 0, slowest = 100, lowest = 0;
  for (int i = 0; i < 1200; ++i) {
    world.step(kDt_s, 4);
    const BodyState now = world.state(id);
    farthest = std::max(farthest, now.X_WB.position.norm());
    lowest = std::min(lowest, now.X_WB.position.y());
    slowest = std::min(slowest, now.velocity_W.norm());
  }
  EXPECT_LT(farthest, 3.001);
  EXPECT_GT(slowest, 1.99) << "speed after ten seconds";
  EXPECT_LT(lowest, -2.9) << "the ball reached the far side";
}

TEST(Joint, ACantileverOfFixedJointsStaysStraight) {
  RigidWorld world(awake());
  BodyId last;
  std::vector<JointDesc> joints;
  for (int i = 0; i < 10; ++i) {
    const BodyId next = world.add(W::box(Vec3(0.2, 0.1, 0.1), Vec3(0.1 + 0.2 * i, 0, 0)));
    joints.push_back(joint_at(world, Kind::kFixed, last, next, Vec3(0.2 * i, 0, 0)));
    world.physics().join(joints.back());
    last = next;
  }
  world.run(3, kDt_s, kSubsteps);
  std::printf("cantilever of 2 m: tip sinks %.2e m\n", -world.state(last).X_WB.position.y());
  EXPECT_LT(std::abs(world.state(last).X_WB.position.y()), 1e-3);
}

TEST(Joint, ALoadBreaksAJointAtItsLimitAndMomentumStays) {
  for (const bool overloaded : {false, true}) {
    RigidWorld world(awake());
    const BodyDesc box = W::box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0));
    const BodyId id = world.add(box);
    JointDesc joint = joint_at(world, Kind::kBall, {}, id, Vec3(0, 0.25, 0));
    joint.breaking_N = box.mass_kg * kG * (overloaded ? 0.98 : 1.02);
    world.physics().join(joint);
    world.run(1, kDt_s, kSubsteps);
    EXPECT_EQ(world.physics().take_broken().size(), overloaded ? 1u : 0u);
    EXPECT_EQ(world.state(id).X_WB.position.y() < -1, overloaded);
  }
  for (const bool overloaded : {false, true}) {  // A beam held at its end bears m·g·L/2.
    RigidWorld world(awake());
    const BodyDesc beam = W::box(Vec3(1, 0.1, 0.1), Vec3(0.5, 0, 0));
    const BodyId id = world.add(beam);
    JointDesc joint = joint_at(world, Kind::kFixed, {}, id, Vec3::Zero());
    joint.breaking_Nm = beam.mass_kg * kG * 0.5 * (overloaded ? 0.98 : 1.02);
    world.physics().join(joint);
    world.run(1, kDt_s, kSubsteps);
    EXPECT_EQ(world.physics().take_broken().size(), overloaded ? 1u : 0u);
  }
  // Two spheres orbit each other; the centripetal force exceeds the joint's limit by a ninth.
  RigidWorld world(awake(Vec3::Zero()));
  BodyDesc a = W::sphere(0.1, Vec3(-0.5, 0, 0)), b = W::sphere(0.1, Vec3(0.5, 0, 0));
  a.velocity_W = Vec3(1, -2, 0), b.velocity_W = Vec3(1, 2, 0);
  const BodyId one = world.add(a), two = world.add(b);
  JointDesc joint = joint_at(world, Kind::kDistance, one, two, Vec3::Zero());
  joint.anchor_a_R = joint.anchor_b_R = Vec3::Zero();
  joint.length_m = 1;
  joint.breaking_N = 0.9 * a.mass_kg * 4 / 0.5;
  world.physics().join(joint);
  const Vec3 before = world.momentum(), spin = world.angular_momentum();
  world.run(0.5, kDt_s, kSubsteps);
  EXPECT_EQ(world.physics().take_broken().size(), 1u);
  EXPECT_LT((world.momentum() - before).norm(), 1e-6 * before.norm());
  EXPECT_LT((world.angular_momentum() - spin).norm(), 1e-5 * spin.norm());
}

TEST(Joint, ReportsTheExternalImpulseOfTheWorld) {
  RigidWorld world(awake());
  add_chain(world, {.links = 5, .ball_ratio = 20});
  for (int i = 0; i < 120; ++i) {
    const Vec3 before = world.momentum();
    const SolveReport report = world.step(kDt_s, kSubsteps);
    const Vec3 error = world.momentum() - before - report.external_impulse_Ns;
    EXPECT_LT(error.norm(), 2e-5 * (before.norm() + 1));
  }
}

TEST(Joint, JoinedBodiesSleepAndWakeTogether) {
  RigidWorld world;
  world.add(W::ground());
  const BodyId a = world.add(W::box(Vec3(0.5, 0.5, 0.5), Vec3(0, 0.25, 0)));
  const BodyId b = world.add(W::box(Vec3(0.5, 0.5, 0.5), Vec3(2, 0.25, 0)));
  const BodyId hanging = world.add(W::box(Vec3(0.5, 0.5, 0.5), Vec3(4, 2, 0)));
  const BodyId first = world.add(W::box(Vec3(0.5, 0.5, 0.5), Vec3(6, 2, 0)));
  JointDesc rod = joint_at(world, Kind::kDistance, a, b, Vec3(0, 0.25, 0));
  rod.anchor_a_R = rod.anchor_b_R = Vec3::Zero();
  rod.length_m = 2;
  const JointId id = world.physics().join(rod);
  world.physics().join(joint_at(world, Kind::kBall, {}, hanging, Vec3(4, 2.25, 0)));
  world.physics().join(joint_at(world, Kind::kBall, first, {}, Vec3(6, 2.25, 0)));
  world.run(3, kDt_s, 4);
  EXPECT_TRUE(world.state(first).asleep) << "the world may be either end";
  EXPECT_TRUE(world.state(a).asleep && world.state(b).asleep && world.state(hanging).asleep);
  world.physics().apply_impulse(a, Vec3(0, 5, 0), Vec3(0, 0.25, 0));
  world.step(kDt_s, 4);
  EXPECT_FALSE(world.state(b).asleep);
  EXPECT_TRUE(world.state(hanging).asleep);
  world.run(3, kDt_s, 4);
  EXPECT_TRUE(world.state(a).asleep && world.state(b).asleep);
  world.physics().cut(id);
  world.physics().apply_impulse(a, Vec3(0, 5, 0), Vec3(0, 0.25, 0));
  world.run(2, kDt_s, 4);
  world.physics().apply_impulse(a, Vec3(0, 5, 0), Vec3(0, 0.25, 0));
  EXPECT_TRUE(world.state(b).asleep) << "the bodies are no longer joined";
}

/// Returns the sums of force and torque impulses on the body with a tag, about a point.
std::pair<Vec3, Vec3> load_on(RigidWorld& world, std::uint32_t tag, const Vec3& about_W) {
  std::pair<Vec3, Vec3> sum(Vec3::Zero(), Vec3::Zero());
  for (const JointImpulse& load : world.physics().joint_impulses()) {
    if (load.body_tag != tag) continue;
    sum.first += load.impulse_W;
    sum.second += (load.point_W - about_W).cross(load.impulse_W) + load.angular_impulse_W;
  }
  return sum;
}

TEST(Joint, ReportsItsLoadOnBothBodies) {
  for (const Kind kind : {Kind::kRope, Kind::kDistance, Kind::kFixed}) {
    RigidWorld world;
    BodyDesc beam = W::box(Vec3(4, 0.2, 0.2), Vec3::Zero());
    beam.is_static = true;
    beam.tag = 1;
    BodyDesc load = W::box(Vec3(0.5, 0.5, 0.5), Vec3(1.5, -1, 0));
    load.tag = 2;
    beam.reports_load = load.reports_load = true;
    const BodyId a = world.add(beam), b = world.add(load);
    const Vec3 anchor(kind == Kind::kFixed ? 1 : 1.5, 0, 0);  // A rope hangs vertically.
    JointDesc joint = joint_at(world, kind, a, b, anchor);
    if (kind != Kind::kFixed) {
      joint.anchor_b_R = Vec3::Zero();
      joint.length_m = 1;
    }
    world.physics().join(joint);
    for (const double s : {0.5, 3.0}) {
      world.run(s, kDt_s, kSubsteps);
      const Vec3 weight_Ns = kDt_s * load.mass_kg * Vec3(0, -kG, 0);
      const auto [down, turn] = load_on(world, 1, Vec3::Zero());
      EXPECT_LT((down - weight_Ns).norm(), 1e-3 * weight_Ns.norm());
      EXPECT_LT((turn - Vec3(1.5, 0, 0).cross(weight_Ns)).norm(), 1e-3 * weight_Ns.norm());
      const auto [up, back] = load_on(world, 2, Vec3(1.5, -1, 0));
      EXPECT_LT((up + weight_Ns).norm(), 1e-3 * weight_Ns.norm());
      EXPECT_LT(back.norm(), 1e-3 * weight_Ns.norm());
    }
    EXPECT_TRUE(world.state(b).asleep) << "loads of sleeping bodies are reported too";
  }
}

TEST(Joint, BodiesJoinedIndirectlyToAMovingBodyDoNotSleep) {
  for (const double spin_rad_s : {0.0, 20.0}) {
    RigidWorld world;
    world.add(W::ground());
    std::vector<BodyId> bodies;
    for (int i = 0; i < 4; ++i) {
      bodies.push_back(world.add(W::box(Vec3::Ones(), Vec3(1.5 * i, 0.5, 0))));
    }
    BodyDesc wheel = W::sphere(0.2, Vec3(6, 0.5, 0));
    wheel.angular_velocity_W = Vec3(0, 0, spin_rad_s);
    bodies.push_back(world.add(wheel));
    for (std::size_t i = 0; i < 4; ++i) {  // The joint of the wheel is created last.
      const Kind kind = i < 3 ? Kind::kBall : Kind::kHinge;
      const Vec3 at = i < 3 ? Vec3(1.5 * double(i) + 0.75, 0.5, 0) : wheel.X_WB.position;
      world.physics().join(joint_at(world, kind, bodies[i], bodies[i + 1], at));
    }
    bool any = false;
    for (int step = 0; step < 360; ++step) {
      world.step(kDt_s, 4);
      for (const BodyId body : bodies) any |= world.state(body).asleep;
    }
    EXPECT_EQ(any, spin_rad_s == 0);
  }
}

TEST(Joint, BodiesWakeWhenAJointIsMovedToAnotherBody) {
  RigidWorld world;
  world.add(W::ground());
  std::vector<BodyId> boxes;
  for (int i = 0; i < 3; ++i) boxes.push_back(world.add(W::box(Vec3::Ones(), Vec3(3 * i, 0.5, 0))));
  JointDesc rope = joint_at(world, Kind::kRope, boxes[0], boxes[1], Vec3::Zero());
  rope.length_m = 100;
  const JointId id = world.physics().join(rope);
  world.run(3, kDt_s, 4);
  for (const BodyId box : boxes) ASSERT_TRUE(world.state(box).asleep);
  world.physics().attach(id, false, boxes[2]);
  EXPECT_FALSE(world.state(boxes[0]).asleep);
  EXPECT_TRUE(world.state(boxes[1]).asleep);
  EXPECT_FALSE(world.state(boxes[2]).asleep);
}

TEST(Joint, JoinedBodiesIgnoreEachOtherUntilCut) {
  RigidWorld world(awake(Vec3::Zero()));
  const BodyId a = world.add(W::box(Vec3(1, 1, 1), Vec3::Zero()));
  const BodyId b = world.add(W::box(Vec3(1, 1, 1), Vec3(0.8, 0, 0)));
  const JointId id = world.physics().join(joint_at(world, Kind::kBall, a, b, Vec3(0.4, 0, 0)));
  EXPECT_EQ(world.step(kDt_s, 4).contacts, 0u);
  world.physics().cut(id);
  EXPECT_EQ(world.step(kDt_s, 4).contacts, 1u);
}

TEST(Joint, AnEndMovesToAnotherBodyAndAJointWithoutItsBodyHasNoEffect) {
  RigidWorld world(awake());
  const BodyDesc box = W::box(Vec3(0.5, 0.5, 0.5), Vec3(0, -0.25, 0));
  const BodyId old = world.add(box);
  const JointId id = world.physics().join(joint_at(world, Kind::kBall, {}, old, Vec3::Zero()));
  world.run(0.5, kDt_s, 4);
  world.remove(old);
  const BodyId piece = world.add(box);
  world.physics().attach(id, false, piece);
  world.run(0.5, kDt_s, 4);
  EXPECT_NEAR(world.state(piece).X_WB.position.y(), -0.25, 1e-3);
  world.remove(piece);
  const BodyId other = world.add(box);
  world.run(0.5, kDt_s, 4);
  EXPECT_LT(world.state(other).X_WB.position.y(), -1);
}

TEST(Joint, ChainsGiveTheSameBitsForAnyNumberOfThreads) {
  std::uint64_t hashes[3];
  const int before = threads();
  for (int run = 0; run < 3; ++run) {
    set_threads(run == 0 ? 1 : run == 1 ? 2 : 4);
    RigidWorld world;
    world.add(W::ground());
    for (int i = 0; i < 20; ++i) {
      BodyId last;
      for (int k = 0; k < 6; ++k) {
        const BodyId next =
            world.add(W::box(Vec3(0.2, 0.1, 0.1), Vec3(0.1 + 0.2 * k, 1, 0.15 * i)));
        world.physics().join(joint_at(world, k % 2 == 0 ? Kind::kBall : Kind::kHinge, last, next,
                                      Vec3(0.2 * k, 1, 0.15 * i)));
        last = next;
      }
    }
    world.run(1, kDt_s, 4);
    hashes[run] = world.hash();
  }
  set_threads(before);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace sunder::solver::joint_test
