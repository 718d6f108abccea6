// Tests of kinematic bodies: closed forms of the bodies that they carry, push and throw.
#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "solver/planar/planar_physics.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::kinematic_test {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81, kDt_s = 1.0 / 120;
constexpr int kSubsteps = 4;

BodyDesc kinematic(BodyDesc desc, const Vec3& velocity_W = Vec3::Zero(),
                   const Vec3& angular_velocity_W = Vec3::Zero()) {
  desc.is_kinematic = true;
  return W::moving(desc, velocity_W, angular_velocity_W);
}

/// Runs each test with the rigid and the planar solver.
class Kinematic : public testing::TestWithParam<bool> {
 protected:
  static RigidWorld make() {
    return GetParam() ? RigidWorld(make_planar_physics({})) : RigidWorld();
  }
};
INSTANTIATE_TEST_SUITE_P(Both, Kinematic, testing::Bool(),
                         [](const auto& planar) { return planar.param ? "Planar" : "Rigid"; });

TEST_P(Kinematic, MovesAsPrescribedAgainstAnyMass) {
  RigidWorld world = make();
  const BodyId wall =
      world.add(kinematic(W::box(Vec3(1, 1, 1), Vec3::Zero()), Vec3(2, 1, 0), Vec3(0, 0, 0.5)));
  const BodyId block = world.add(W::box(Vec3(4, 4, 4), Vec3(3.5, 0, 0), 8000));
  world.run(1, kDt_s, kSubsteps);
  EXPECT_LT((world.state(wall).X_WB.position - Vec3(2, 1, 0)).norm(), 1e-4) << "Box2D has floats";
  EXPECT_NEAR(world.state(wall).X_WB.rotation.angularDistance(Quat::Identity()), 0.5, 1e-4);
  EXPECT_EQ(world.state(wall).velocity_W, Vec3(2, 1, 0))
      << "gravity must not act on a kinematic body";
  world.physics().apply_impulse(wall, Vec3(1e6, 0, 0), Vec3::Zero());
  EXPECT_EQ(world.state(wall).velocity_W, Vec3(2, 1, 0));
  EXPECT_GT(world.state(block).velocity_W.x(), 1) << "512 t gave way";
}

TEST_P(Kinematic, ABoxOnALiftLoadsItByWeightAndAcceleration) {
  RigidWorld world = make();
  const BodyId lift = world.add(kinematic(W::box(Vec3(4, 1, 1), Vec3(0, -0.5, 0))));
  BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0));
  box.reports_load = true;
  const BodyId id = world.add(box);
  const double a_m_s2 = 2;
  for (int i = 0; i < 240; ++i) {
    BodyState state = world.state(lift);
    state.velocity_W.y() += a_m_s2 * kDt_s;
    world.physics().set_state(lift, state);
    const SolveReport report = world.step(kDt_s, kSubsteps);
    const Vec3 error_Ns =
        report.momentum_after_Ns - report.momentum_before_Ns - report.external_impulse_Ns;
    EXPECT_LT(error_Ns.norm(), 1e-4 * 1000 * kG * kDt_s) << "the lift's impulse is an external one";
  }
  double force_N = 0;
  for (const ContactImpulse& load : world.physics().contact_impulses())
    force_N += load.impulse_W.y() / kDt_s;
  EXPECT_NEAR(force_N / (1000 * (kG + a_m_s2)), 1, 0.02);
  const double up_m = world.state(id).X_WB.position.y() - world.state(lift).X_WB.position.y();
  EXPECT_NEAR(up_m, 1, 0.01);
  EXPECT_NEAR(world.state(id).velocity_W.y(), 4, 0.02);
}

TEST_P(Kinematic, ABoxOnAConveyorSlipsUntilItReachesTheConveyorsSpeed) {
  RigidWorld world = make();
  const double friction = 0.5, v_m_s = 3;
  world.add(kinematic(W::with_friction(W::box(Vec3(40, 1, 1), Vec3(0, -0.5, 0)), friction),
                      Vec3(v_m_s, 0, 0)));
  const BodyId box =
      world.add(W::with_friction(W::box(Vec3(1, 0.2, 1), Vec3(0, 0.1, 0)), friction));
  const double slips_s = v_m_s / (friction * kG);
  world.run(0.5 * slips_s, kDt_s, kSubsteps);
  EXPECT_NEAR(world.state(box).velocity_W.x(), 0.5 * v_m_s, 0.05);
  world.run(2, kDt_s, kSubsteps);
  EXPECT_NEAR(world.state(box).velocity_W.x(), v_m_s, 1e-3);
  const double way_m = v_m_s * (0.5 * slips_s + 2) - 0.5 * v_m_s * slips_s;
  EXPECT_NEAR(world.state(box).X_WB.position.x(), way_m, 0.05);
}

TEST_P(Kinematic, ABallReboundsFromAMovingWallFasterByTheWallsSpeed) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    RigidWorld world = GetParam() ? RigidWorld(make_planar_physics({.gravity_W = Vec3::Zero()}))
                                  : RigidWorld(RigidOptions{.gravity_W = Vec3::Zero()});
    world.add(kinematic(W::with_friction(W::box(Vec3(1, 4, 4), Vec3(-0.5, 0, 0)), 0, restitution),
                        Vec3(3, 0, 0)));
    BodyDesc ball = W::with_friction(W::sphere(0.5, Vec3(2, 0, 0)), 0, restitution);
    ball.velocity_W = Vec3(-5, 0, 0);
    const BodyId id = world.add(ball);
    world.run(1, kDt_s, kSubsteps);
    EXPECT_NEAR(world.state(id).velocity_W.x(), 3 + restitution * 8, 0.02) << restitution;
  }
}

TEST_P(Kinematic, SleepingBodiesWakeWhenTheirSupportMovesAndRideAlong) {
  RigidWorld world = make();
  const BodyId lift = world.add(kinematic(W::box(Vec3(4, 1, 1), Vec3(0, -0.5, 0))));
  std::vector<BodyId> boxes;
  for (int i = 0; i < 3; ++i)
    boxes.push_back(world.add(W::box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0))));
  world.run(4, kDt_s, kSubsteps);
  for (const BodyId box : boxes) EXPECT_TRUE(world.state(box).asleep);
  BodyState state = world.state(lift);
  for (const double v_m_s : {-0.02, 0.02}) {  // Slower than the speed of a body at rest.
    state = world.state(lift);
    state.velocity_W.y() = v_m_s;
    world.physics().set_state(lift, state);
    world.run(4, kDt_s, kSubsteps);
    for (const BodyId box : boxes) EXPECT_NEAR(world.state(box).velocity_W.y(), v_m_s, 2e-3);
  }
  state = world.state(lift);
  state.velocity_W.setZero();
  world.physics().set_state(lift, state);
  world.run(4, kDt_s, kSubsteps);
  for (const BodyId box : boxes)
    EXPECT_TRUE(world.state(box).asleep) << "the lift is at rest again";
}

TEST(Turntable, CarriesBodiesUpToTheRadiusThatFrictionAllows) {
  RigidWorld world;
  const double spin_rad_s = 1.5, friction = 0.5;
  const double most_m = friction * kG / (spin_rad_s * spin_rad_s);
  world.add(W::with_friction(
      kinematic(W::box(Vec3(9, 1, 9), Vec3(0, -0.5, 0)), Vec3::Zero(), Vec3(0, spin_rad_s, 0)),
      friction));
  const auto put = [&](double radius_m) {
    BodyDesc box = W::with_friction(W::box(Vec3(0.4, 0.1, 0.4), Vec3(radius_m, 0.05, 0)), friction);
    box.velocity_W = Vec3(0, 0, -spin_rad_s * radius_m);
    box.angular_velocity_W = Vec3(0, spin_rad_s, 0);
    return world.add(box);
  };
  const BodyId inner = put(0.8 * most_m), outer = put(1.2 * most_m);
  world.run(4, kDt_s, kSubsteps);
  const BodyState state = world.state(inner);
  EXPECT_NEAR(state.X_WB.position.norm(), 0.8 * most_m, 0.03);
  EXPECT_LT((state.velocity_W - Vec3(0, spin_rad_s, 0).cross(state.X_WB.position)).norm(), 0.05);
  EXPECT_NEAR(state.angular_velocity_W.y(), spin_rad_s, 0.02);
  EXPECT_GT(world.state(outer).X_WB.position.norm(), 1.5 * most_m);
}

/// Returns the distance between the two anchors of a joint, in m.
double gap_m(const RigidWorld& world, const JointDesc& joint) {
  return (world.state(joint.b).X_WB * joint.anchor_b_R -
          world.state(joint.a).X_WB * joint.anchor_a_R)
      .norm();
}

TEST(Crane, AChainBelowACraneInUniformMotionStaysVertical) {
  RigidWorld world;
  const Vec3 v_m_s(3, 0.5, -1);
  const BodyId crane = world.add(kinematic(W::box(Vec3(1, 0.2, 1), Vec3(0, 10, 0)), v_m_s));
  BodyId above = crane;
  std::vector<BodyId> links;
  std::vector<JointDesc> joints;
  for (int i = 0; i < 12; ++i) {
    BodyDesc link = i == 11 ? W::sphere(0.3, Vec3(0, 7.3, 0), 8000)
                            : W::box(Vec3(0.05, 0.2, 0.05), Vec3(0, 9.7 - 0.2 * i, 0), 4000);
    links.push_back(world.add(W::moving(link, v_m_s)));
    const Vec3 at_W(0, 9.8 - 0.2 * i, 0);
    joints.push_back(joint_at(world, JointKind::kBall, above, links.back(), at_W));
    world.physics().join(joints.back());
    above = links.back();
  }
  for (int i = 0; i < 360; ++i) {
    const SolveReport report = world.step(kDt_s, kSubsteps);
    const Vec3 error_Ns =
        report.momentum_after_Ns - report.momentum_before_Ns - report.external_impulse_Ns;
    EXPECT_LT(error_Ns.norm(), 1e-4 * report.mass_kg * kG * kDt_s);
  }
  const Vec3 below = world.state(links.back()).X_WB.position - world.state(crane).X_WB.position;
  EXPECT_LT((below - Vec3(0, -2.7, 0)).norm(), 0.005);
  EXPECT_LT((world.state(links.back()).velocity_W - v_m_s).norm(), 0.005);
  for (const JointDesc& joint : joints) EXPECT_LT(gap_m(world, joint), 0.001);
}

TEST(Crane, LiftsALoadByWeightAndAcceleration) {
  RigidWorld world;
  const BodyId crane = world.add(kinematic(W::box(Vec3(1, 0.2, 1), Vec3(0, 10, 0))));
  BodyDesc load = W::box(Vec3(1, 1, 1), Vec3(0, 7, 0));
  load.reports_load = true;
  const BodyId id = world.add(load);
  JointDesc rope = joint_at(world, JointKind::kRope, crane, id, Vec3(0, 7.5, 0));
  rope.anchor_a_R = Vec3(0, -0.1, 0);
  rope.length_m = 2.4;
  world.physics().join(rope);
  world.run(4, kDt_s, kSubsteps);
  EXPECT_TRUE(world.state(id).asleep) << "while the crane is at rest";
  const double a_m_s2 = 2;
  double force_N = 0;
  for (int i = 0; i < 240; ++i) {
    BodyState state = world.state(crane);
    state.velocity_W.y() += a_m_s2 * kDt_s;
    world.physics().set_state(crane, state);
    world.step(kDt_s, kSubsteps);
    force_N = 0;
    for (const JointImpulse& by : world.physics().joint_impulses())
      force_N += by.impulse_W.y() / kDt_s;
  }
  EXPECT_NEAR(force_N / (1000 * (kG + a_m_s2)), 1, 0.01);
  EXPECT_NEAR(world.state(id).velocity_W.y(), 4, 0.03);
}

TEST(Crane, TurnsTheBodyFixedToIt) {
  RigidWorld world(RigidOptions{.gravity_W = Vec3::Zero()});
  const Vec3 spin(0, 1.5, 0);
  const BodyId crane =
      world.add(kinematic(W::box(Vec3(1, 1, 1), Vec3::Zero()), Vec3::Zero(), spin));
  const BodyDesc box = W::box(Vec3(1, 0.5, 0.5), Vec3(2, 0, 0));
  const BodyId id = world.add(W::moving(box, spin.cross(box.X_WB.position), spin));
  const JointDesc joint = joint_at(world, JointKind::kFixed, crane, id, Vec3(1, 0, 0));
  world.physics().join(joint);
  world.run(3, kDt_s, kSubsteps);
  const BodyState state = world.state(id);
  EXPECT_LT((state.X_WB.position - world.state(crane).X_WB * Vec3(2, 0, 0)).norm(), 0.005);
  EXPECT_LT((state.velocity_W - spin.cross(state.X_WB.position)).norm(), 0.01);
  EXPECT_LT((state.angular_velocity_W - spin).norm(), 0.005);
}

/// Returns the hash of a world of balls and boxes on a shaken plate, swept by an arm that turns.
std::uint64_t shaken(int threads, int lanes) {
  set_threads(threads);
  RigidOptions options;
  options.lanes = lanes;
  RigidWorld world(options);
  world.add(W::ground());
  const BodyId plate = world.add(kinematic(W::box(Vec3(4, 0.4, 4), Vec3(0, 0.2, 0))));
  world.add(kinematic(W::box(Vec3(4, 0.3, 0.2), Vec3(0, 0.8, 0)), Vec3::Zero(), Vec3(0, 2, 0)));
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3 at(random.uniform(-1.6, 1.6), random.uniform(0.7, 4), random.uniform(-1.6, 1.6));
    world.add(i % 2 ? W::sphere(0.12, at) : W::box(Vec3(0.2, 0.3, 0.25), at));
  }
  for (int i = 0; i < 200; ++i) {
    BodyState state = world.state(plate);
    state.velocity_W = Vec3(i % 40 < 20 ? 0.5 : -0.5, 0, 0);
    world.physics().set_state(plate, state);
    world.step(kDt_s, kSubsteps);
  }
  set_threads(0);
  return world.hash();
}

TEST(KinematicBits, AreTheSameForAnyThreadsAndLanes) {
  const std::uint64_t one = shaken(1, 1);
  EXPECT_EQ(shaken(2, 4), one);
  EXPECT_EQ(shaken(4, 8), one);
}

}  // namespace
}  // namespace sunder::solver::kinematic_test
