// Tests of the planar solver behind Physics, and of its refusal of bodies that are not planar.
#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "engine/geometry/prism.h"
#include "solver/planar/planar_physics.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::planar_test {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81;

RigidWorld plane(double piece_m = 1, bool sleeping = true) {
  PlanarOptions options;
  options.piece_m = piece_m;
  options.sleeping = sleeping;
  return RigidWorld(make_planar_physics(options));
}

BodyDesc column(int sides, const Vec3& center_W) {
  std::vector<Vec3> corners;
  for (int i = 0; i < sides; ++i) {
    const SinCos a = sin_cos(6.283185307179586 * i / sides);
    for (const double z : {-0.5, 0.5}) corners.emplace_back(0.5 * a.cos, 0.5 * a.sin, z);
  }
  return W::hull(make_hull(corners), center_W);
}

/// Returns the message of the error that refuses a body.
std::string refusal(const BodyDesc& desc) {
  RigidWorld world = plane();
  try {
    world.add(desc);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Prism, HasAConvexCounterClockwiseOutline) {
  const std::optional<ZPrism> box = prism_along_z(make_box(Vec3(0, 0, -1), Vec3(2, 1, 3)), {});
  ASSERT_TRUE(box);
  ASSERT_EQ(box->outline.size(), 4u);
  EXPECT_EQ(box->low, -1);
  EXPECT_EQ(box->high, 3);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 a = box->outline[i], b = box->outline[(i + 1) % 4];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_DOUBLE_EQ(area, 2);
}

TEST(Prism, IsRefusedForShapesThatNarrowAlongZ) {
  const std::vector<Vec3> corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  EXPECT_FALSE(prism_along_z(make_hull(corners), {}));
  const Pose leaning{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX()))};
  EXPECT_FALSE(prism_along_z(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), leaning));
}

TEST(Planar, ABodyFallsAsFarAsInThreeDimensionsAndKeepsItsZ) {
  for (const double piece_m : {0.25, 1.0, 4.0}) {
    RigidWorld world = plane(piece_m);
    BodyDesc desc = W::box(Vec3(1, 1, 1), Vec3(0, 100, 0.2));
    desc.velocity_W = Vec3(3, 5, 0);
    desc.angular_velocity_W = Vec3(0, 0, 2);
    const BodyId id = world.add(desc);
    world.run(1, 1.0 / 240, 4);
    const BodyState s = world.state(id);
    EXPECT_NEAR(s.X_WB.position.x(), 3, 1e-3);
    EXPECT_NEAR(s.X_WB.position.y(), 105 - 0.5 * kG, 0.01);
    EXPECT_EQ(s.X_WB.position.z(), 0.2);
    EXPECT_NEAR(s.velocity_W.y(), 5 - kG, 1e-4);
    EXPECT_NEAR(s.X_WB.rotation.angularDistance(Quat::Identity()), 2, 1e-3);
  }
}

TEST(Planar, BoxesAndSpheresRest) {
  RigidWorld world = plane();
  world.add(W::ground());
  const BodyId box = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  const BodyId wheel = world.add(W::fixed(column(20, Vec3(5, 0.5, 0))));
  const BodyId rider = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0)));
  const BodyId ball = world.add(W::sphere(0.3, Vec3(-4, 0.3, 0)));
  world.run(3, 1.0 / 60, 4);
  EXPECT_NEAR(world.state(box).X_WB.position.y(), 0.5, 2e-3);
  EXPECT_NEAR(world.state(rider).X_WB.position.y(), 1.5, 4e-3);
  EXPECT_NEAR(world.state(ball).X_WB.position.y(), 0.3, 2e-3);
  EXPECT_TRUE(world.state(rider).asleep);
  EXPECT_EQ(world.state(wheel).X_WB.position, Vec3(5, 0.5, 0));
}

TEST(Planar, APrismOfTwentySidesRollsDownASlope) {
  PlanarOptions options;
  options.gravity_W = Vec3(2.5, -9.4, 0);
  RigidWorld world(make_planar_physics(options));
  world.add(W::with_friction(W::ground(), 1));
  const BodyId id = world.add(W::with_friction(column(20, Vec3(0, 0.5, 0)), 1));
  world.run(2, 1.0 / 240, 4);
  EXPECT_GT(world.state(id).X_WB.position.x(), 1);
  EXPECT_NEAR(world.state(id).X_WB.position.y(), 0.497, 0.01);
}

TEST(Planar, BodiesThatAreNotPlanarAreRefusedByNameAndChangeNothing) {
  BodyDesc leaning = W::box(Vec3(1, 1, 1), Vec3(0, 0, 0));
  leaning.tag = 17;
  leaning.X_WB.rotation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  EXPECT_NE(refusal(leaning).find("body 17 is not a prism along z"), std::string::npos);
  EXPECT_NE(refusal(W::box(Vec3(1, 1, 1), Vec3(0, 0, 2))).find("does not cross the plane"),
            std::string::npos);
  EXPECT_NE(refusal(W::sphere(1, Vec3(0, 0, 0.1))).find("centre is off the plane"),
            std::string::npos);
  EXPECT_NE(
      refusal(W::ground(Vec3(0, 1, 1))).find("is a half-space whose normal has a z component"),
      std::string::npos);

  RigidWorld world = plane();
  const BodyId kept = world.add(W::box(Vec3(1, 1, 1), Vec3::Zero()));
  EXPECT_THROW(world.physics().replace(std::span(&kept, 1), std::span(&leaning, 1)), InputError);
  EXPECT_EQ(world.state(kept).X_WB.position, Vec3(Vec3::Zero()));
}

TEST(Planar, ClosingContactsHaveSpeedAndMassOfBodiesThatMeetWithinTheStep) {
  RigidWorld world = plane();
  BodyDesc ball = W::sphere(0.5, Vec3(-1.6, 0, 0));
  ball.velocity_W = Vec3(20, 0, 0);
  ball.tag = 1;
  BodyDesc wall = W::fixed(W::box(Vec3(2, 4, 1), Vec3::Zero()));
  wall.tag = 2;
  world.add(ball);
  world.add(wall);
  world.physics().collide(1.0 / 240);  // The ball moves 8 cm, too little to reach the wall.
  EXPECT_TRUE(world.physics().speculative_contacts().empty());
  world.physics().collide(1.0 / 60);
  const std::vector<SpeculativeContact> found = world.physics().speculative_contacts();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].body_tag_a, 1u);
  EXPECT_EQ(found[0].body_tag_b, 2u);
  EXPECT_NEAR(found[0].speed_m_s, 20, 1e-5);
  EXPECT_NEAR(found[0].separation_m, 0.1, 1e-4);
  EXPECT_NEAR(found[0].normal_W.x(), 1, 1e-6);
  EXPECT_NEAR(found[0].effective_mass_kg, ball.mass_kg, 1e-3 * ball.mass_kg);
}

TEST(Planar, ClosingContactsAreFoundWhicheverBodyMoves) {
  for (const int fast : {0, 1}) {
    RigidWorld world = plane();
    for (const int i : {0, 1}) {
      BodyDesc ball = W::sphere(0.5, Vec3(i == 0 ? -0.6 : 0.6, 0, 0));
      if (i == fast) ball.velocity_W = Vec3(i == 0 ? 20 : -20, 0, 0);
      world.add(ball);
    }
    world.physics().collide(1.0 / 60);
    EXPECT_EQ(world.physics().speculative_contacts().size(), 1u) << fast;
  }
}

TEST(Planar, PenetrationsAreOfContactsUnderLoad) {
  RigidWorld world = plane();
  world.add(W::ground());
  world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  world.run(0.25, 1.0 / 60, 4);
  const std::vector<float> depths_m = world.physics().penetrations();
  ASSERT_EQ(depths_m.size(), 2u) << "at either corner";
  for (const float depth_m : depths_m) EXPECT_LT(depth_m, 2e-3f);
  PlanarOptions weightless;
  weightless.gravity_W = Vec3::Zero();
  RigidWorld loose(make_planar_physics(weightless));
  loose.add(W::ground());
  loose.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  loose.run(0.25, 1.0 / 60, 4);
  EXPECT_TRUE(loose.physics().penetrations().empty());
}

TEST(Planar, BodiesAtRestTwoMillimetresApartTouch) {
  RigidWorld world = plane();
  world.add(W::fixed(W::box(Vec3(2, 1, 1), Vec3(0, -0.5, 0))));
  const BodyId id = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.502, 0)));
  world.physics().collide(1e-6);
  const std::vector<Touch> touches = world.physics().touches(std::span(&id, 1));
  ASSERT_EQ(touches.size(), 2u);
  for (const Touch& touch : touches) EXPECT_NEAR(touch.separation_m, 0.002, 1e-5);
}

TEST(Planar, TouchesHaveBothBodiesAndThePoint) {
  RigidWorld world = plane();
  world.add(W::ground());
  BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0));
  box.tag = 7;
  const BodyId id = world.add(box);
  world.physics().collide(1.0 / 60);
  const std::vector<Touch> touches = world.physics().touches(std::span(&id, 1));
  ASSERT_EQ(touches.size(), 2u);
  for (const Touch& touch : touches) {
    EXPECT_EQ(touch.body_tag_b, 7u);
    EXPECT_NEAR(touch.separation_m, 0, 1e-6);
    EXPECT_NEAR(touch.arm_b_W.y(), -0.5, 1e-6);
    EXPECT_NEAR(std::abs(touch.arm_b_W.x()), 0.5, 1e-5);
  }
}

TEST(Planar, ASpinningBodyTouchesNothingBeyondItsReach) {
  for (const double gap_m : {0.3, 0.6}) {
    RigidWorld world = plane();
    const BodyDesc bar =
        W::moving(W::box(Vec3(1, 0.2, 1), Vec3::Zero()), Vec3::Zero(), Vec3(0, 0, 300));
    const BodyId id = world.add(bar);
    world.add(W::fixed(W::box(Vec3::Ones(), Vec3(1 + gap_m, 0, 0))));
    world.physics().collide(1.0 / 60);
    // The bar's corner is 0.51 m from its centre.
    EXPECT_EQ(world.physics().touches(std::span(&id, 1)).empty(), gap_m > 0.51) << gap_m;
  }
}

/// Returns the sum of the contact impulses on the body with a tag.
Vec3 load_on(Physics& physics, std::uint32_t tag) {
  Vec3 sum = Vec3::Zero();
  for (const ContactImpulse& load : physics.contact_impulses())
    if (load.body_tag == tag) sum += load.impulse_W;
  return sum;
}

TEST(Planar, ATableBearsTheWeightOfABoxAwakeAndAsleep) {
  RigidWorld world = plane();
  BodyDesc table = W::fixed(W::box(Vec3(4, 1, 1), Vec3::Zero()));
  table.tag = 3;
  table.reports_load = true;
  world.add(table);
  const BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(0, 1, 0));
  const BodyId id = world.add(box);
  const double dt = 1.0 / 60;
  world.run(0.4, dt, 4);
  EXPECT_FALSE(world.state(id).asleep);
  EXPECT_NEAR(load_on(world.physics(), 3).y(), -box.mass_kg * kG * dt,
              0.02 * box.mass_kg * kG * dt);
  world.run(3, dt, 4);
  EXPECT_TRUE(world.state(id).asleep);
  EXPECT_NEAR(load_on(world.physics(), 3).y(), -box.mass_kg * kG * dt,
              0.02 * box.mass_kg * kG * dt);
}

TEST(Planar, SleepsOnlyIfItMay) {
  for (const bool sleeping : {true, false}) {
    RigidWorld world = plane(1, sleeping);
    world.add(W::ground());
    const BodyId id = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
    world.run(300, 1.0 / 60, 4);
    EXPECT_EQ(world.state(id).asleep, sleeping);
  }
}

TEST(Planar, MomentumChangesByTheExternalImpulseOnly) {
  RigidWorld world = plane(1, true);
  world.add(W::ground());
  for (int i = 0; i < 6; ++i) {
    BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(0.1 * i, 0.6 + 1.2 * i, 0));
    box.velocity_W = Vec3(1 - 0.4 * i, 0, 0);
    world.add(box);
  }
  for (int i = 0; i < 300; ++i) {
    const Vec3 before = world.momentum();
    const SolveReport report = world.step(1.0 / 60, 4);
    EXPECT_LT((world.momentum() - before - report.external_impulse_Ns).norm(), 1) << "step " << i;
    EXPECT_LT((world.momentum() - report.momentum_after_Ns).norm(), 1) << "step " << i;
  }
}

TEST(Planar, EditsRemoveAndAddSupports) {
  RigidWorld world = plane();
  BodyDesc table = W::fixed(W::box(Vec3(4, 1, 1), Vec3::Zero()));
  table.shapes[0].tag = 5;
  const BodyId table_id = world.add(table);
  const BodyId box = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 1, 0)));
  world.run(2, 1.0 / 60, 4);
  ASSERT_TRUE(world.state(box).asleep);
  const std::uint32_t tag = 5;
  const ConvexPolyhedron lower = make_box(Vec3(-2, -2, -0.5), Vec3(2, -1.5, 0.5));
  ShapeDesc shape;
  shape.hull = &lower;
  world.physics().edit({table_id, std::span(&tag, 1), std::span(&shape, 1)});
  world.run(3, 1.0 / 60, 4);
  EXPECT_NEAR(world.state(box).X_WB.position.y(), -1, 5e-3);
}

TEST(Planar, ABallAtAThousandMetresPerSecondDoesNotPassThroughAWallOfOneCentimetre) {
  for (const bool is_static : {true, false}) {
    RigidWorld world = plane(0.1);
    BodyDesc wall = W::box(Vec3(0.01, 2, 1), Vec3(0, 0, 0));
    wall.is_static = is_static;
    const BodyId wall_id = world.add(wall);
    BodyDesc ball = W::sphere(0.05, Vec3(-1, 0.01, 0));
    ball.velocity_W = Vec3(1000, 0, 0);
    const BodyId id = world.add(ball);
    world.run(0.1, 1.0 / 60, 4);
    EXPECT_LT(world.state(id).X_WB.position.x(), world.state(wall_id).X_WB.position.x());
  }
}

TEST(Planar, ABodyThatIsNoLongerFiniteIsFrozenAndCounted) {
  RigidWorld world = plane();
  world.add(W::ground());
  const BodyId id = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  world.physics().apply_impulse(id, Vec3(NAN, 0, 0), Vec3::Zero());
  EXPECT_EQ(world.step(1.0 / 60, 4).frozen, 1u);
  EXPECT_EQ(world.step(1.0 / 60, 4).frozen, 0u);
  EXPECT_TRUE(world.state(id).X_WB.position.allFinite());
}

TEST(Planar, ABodyOverTheSpeedLimitIsFrozenAndItsMomentumIsReported) {
  PlanarOptions weightless;
  weightless.gravity_W = Vec3::Zero();
  RigidWorld world(make_planar_physics(weightless));
  const BodyDesc box = W::box(Vec3(1, 1, 1), Vec3::Zero());
  const BodyId id = world.add(box);
  world.physics().apply_impulse(id, Vec3(2e9 * box.mass_kg, 0, 0), Vec3::Zero());
  const SolveReport report = world.step(1.0 / 60, 4);
  EXPECT_EQ(report.frozen, 1u);
  EXPECT_EQ(report.momentum_after_Ns, Vec3(Vec3::Zero()));
  EXPECT_NEAR(report.external_impulse_Ns.x(), -report.momentum_before_Ns.x(), 1e-5 * 2e9 * 1e4);
  EXPECT_EQ(world.state(id).velocity_W, Vec3(Vec3::Zero()));
}

TEST(Planar, GivesTheSameBitsInEveryRunForAnyNumberOfThreads) {
  const auto run = [](int count) {
    set_threads(count);
    RigidWorld world = plane(0.5);
    world.add(W::ground());
    for (int i = 0; i < 60; ++i) {
      BodyDesc box = W::box(Vec3(0.5, 0.4, 0.3), Vec3(0.3 * (i % 5), 0.5 + 0.6 * i, 0));
      box.angular_velocity_W = Vec3(0, 0, i - 30);
      world.add(box);
    }
    world.run(2, 1.0 / 60, 4);
    return world.hash();
  };
  const std::uint64_t once = run(1);
  EXPECT_EQ(once, run(1));
  EXPECT_EQ(once, run(4));
}

}  // namespace
}  // namespace sunder::solver::planar_test
