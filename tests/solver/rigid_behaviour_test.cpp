// Tests of the rigid solver beyond the reference behaviour in bench/truths: sleep, determinism, and
// reports of contacts, loads and momentum.
#include <algorithm>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/hull.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

RigidOptions weightless() {
  RigidOptions options;
  options.gravity_W = Vec3::Zero();
  options.sleeping = false;
  return options;
}

ConvexPolyhedron rubble_hull(Random& random, double size_m) {
  std::vector<Vec3> points;
  for (int i = 0; i < 12; ++i) points.push_back(0.5 * size_m * random.direction());
  return make_hull(points);
}

void add_pile(RigidWorld& world, int count, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const Vec3 at(0.45 * (i % 4) + random.uniform(0, 0.1), 0.3 + 0.4 * (i / 16),
                  0.45 * (i / 4 % 4) + random.uniform(0, 0.1));
    world.add(W::hull(rubble_hull(random, random.uniform(0.2, 0.5)), at, 2000));
  }
}

TEST(RigidPhysics, GivesTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::vector<std::uint64_t>> hashes;
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    RigidWorld world;
    world.add(W::ground());
    add_pile(world, 200, 9);
    BodyDesc ball = W::sphere(0.4, Vec3(-6, 1, 0.7), 7000);
    ball.velocity_W = Vec3(20, 0, 0);
    world.add(ball);
    std::vector<std::uint64_t>& mine = hashes.emplace_back();
    for (int i = 0; i < 300; ++i) {
      world.step(1.0 / 120, 2);
      mine.push_back(world.hash());
    }
  }
  set_threads(0);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(RigidPhysics, CountsContactsAndTheirPoints) {
  RigidWorld world;
  world.add(W::ground());
  for (const double x : {0.0, 3.0}) world.add(W::box(Vec3::Ones(), Vec3(x, 0.5, 0)));
  const SolveReport report = world.step(1.0 / 60, 5);
  EXPECT_EQ(report.contacts, 2u);
  EXPECT_EQ(report.contact_points, 8u);
}

TEST(RigidPhysics, APileFallsAsleepAndStaysAsleep) {
  RigidWorld world;
  world.add(W::ground());
  add_pile(world, 100, 11);
  SolveReport report;
  double slept_s = 0;
  for (int i = 0; i < 60 * 12; ++i) {
    report = world.step(1.0 / 60, 4);
    if (report.awake == 0) slept_s += 1.0 / 60;
  }
  EXPECT_EQ(report.awake, 0u);
  EXPECT_GT(slept_s, 2);
  std::vector<float> depths = world.physics().penetrations();
  ASSERT_FALSE(depths.empty());
  std::sort(depths.begin(), depths.end());
  EXPECT_LT(depths[depths.size() * 99 / 100], 0.005f);
}

TEST(RigidPhysics, ASleepingBodyWakesWhenItIsStruckPushedOrLosesItsSupport) {
  for (const char* how : {"touch", "push", "support"}) {
    RigidWorld world;
    world.add(W::ground());
    const BodyId low = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0), 100));
    const BodyId high = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0), 100));
    world.run(4, 1.0 / 60, 4);
    ASSERT_TRUE(world.state(high).asleep) << how;
    if (how[0] == 't') {
      BodyDesc ball = W::sphere(0.2, Vec3(-2, 1.5, 0));
      ball.velocity_W = Vec3(10, 0, 0);
      world.add(ball);
    } else if (how[0] == 'p') {
      world.physics().apply_impulse(low, Vec3(500, 0, 0), Vec3(0, 0.5, 0));
    } else {
      world.remove(low);
    }
    world.run(0.5, 1.0 / 60, 4);
    const Vec3 moved = world.state(high).X_WB.position - Vec3(0, 1.5, 0);
    EXPECT_GT(moved.norm(), 0.01) << how;
  }
}

TEST(RigidPhysics, ANotFiniteBodyIsFrozenAndCounted) {
  RigidWorld world;
  world.add(W::ground());
  add_pile(world, 20, 2);
  const BodyId id = world.add(W::box(Vec3(0.3, 0.3, 0.3), Vec3(0.5, 0.6, 0.5)));
  world.physics().apply_impulse(id, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0),
                                world.state(id).X_WB.position);
  EXPECT_EQ(world.step(1.0 / 60, 2).frozen, 1u);
  EXPECT_EQ(world.run(1, 1.0 / 60, 2).frozen, 0u);
  EXPECT_TRUE(world.state(id).velocity_W.isZero());
  for (std::size_t i = 1; i < world.size(); ++i)
    EXPECT_TRUE(world.state(world.id(i)).X_WB.position.allFinite());
}

TEST(RigidPhysics, ReportsClosingContactsBeforeTheBodiesTouch) {
  RigidWorld world(weightless());
  BodyDesc wall = W::fixed(W::box(Vec3(0.1, 2, 2), Vec3::Zero()));
  wall.tag = 4;
  world.add(wall);
  BodyDesc ball = W::sphere(0.2, Vec3(-0.5, 0.3, 0), 7800);
  ball.velocity_W = Vec3(20, 0, 0);
  world.add(ball);
  world.physics().collide(1.0 / 60);
  const std::vector<SpeculativeContact> speculative_contacts =
      world.physics().speculative_contacts();
  ASSERT_EQ(speculative_contacts.size(), 1u);
  const SpeculativeContact& approach = speculative_contacts[0];
  EXPECT_NEAR(approach.speed_m_s, 20, 1e-4);
  EXPECT_NEAR(approach.effective_mass_kg, ball.mass_kg, 1e-3 * ball.mass_kg);
  EXPECT_NEAR(approach.separation_m, 0.25, 1e-5);
  EXPECT_EQ(approach.body_tag_a + approach.body_tag_b, 4u);
  EXPECT_LT((approach.point_W - Vec3(-0.05, 0.3, 0)).norm(), 1e-4);
}

/// Returns the number of steps until the closing contact of a cube with a tilted plank is reported.
/// The bodies in the world are the same whether or not their shapes were modelled rotated.
int steps_to_closing_contact(bool rotated) {
  RigidWorld world(weightless());
  BodyDesc plank = W::box(rotated ? Vec3(0.1, 2, 2) : Vec3(2, 0.1, 2), Vec3::Zero());
  BodyDesc cube = W::box(Vec3::Constant(0.4), Vec3(-1.2, 0, 0));
  const double angle = (rotated ? -0.25 : 0.25) * 3.14159265358979;
  plank.X_WB.rotation = cube.X_WB.rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
  cube.velocity_W = Vec3(20, 0, 0);
  world.add(W::fixed(plank));
  world.add(cube);
  for (int step = 0; step < 20; ++step) {
    world.physics().collide(1.0 / 200);
    if (!world.physics().speculative_contacts().empty()) return step;
    world.physics().solve(1.0 / 200, 1);
  }
  return -1;
}

TEST(RigidPhysics, ReportsAClosingContactForAnyRotationOfTheModels) {
  // The cube's face is 1.2/√2 − 0.25 m from the plank's face, and closes by 0.1/√2 m per step.
  EXPECT_EQ(steps_to_closing_contact(false), 8);
  EXPECT_EQ(steps_to_closing_contact(true), 8);
}

TEST(RigidPhysics, ReportsContactLoadsOnABodyAsleepOrAwake) {
  RigidWorld world;
  BodyDesc table = W::fixed(W::box(Vec3(2, 1, 2), Vec3(0, 0.5, 0)));
  table.reports_load = true;
  table.tag = 7;
  table.shapes[0].tag = 3;
  world.add(table);
  const BodyId weight = world.add(W::box(Vec3::Constant(0.4), Vec3(0.5, 1.2, 0.25)));
  const double dt = 1.0 / 120, mass = 64;
  Vec3 sum = Vec3::Zero();
  double falling = 0;
  for (int i = 0; i < 240; ++i) {
    world.step(dt, 4);
    for (const ContactImpulse& load : world.physics().contact_impulses()) sum += load.impulse_W;
    falling += mass * 9.81 * dt;
    if (world.state(weight).asleep) break;
  }
  ASSERT_TRUE(world.state(weight).asleep);
  EXPECT_NEAR(sum.y(), -falling, 0.01 * falling);  // The table stopped all of the box's fall.
  world.step(dt, 4);
  const std::vector<ContactImpulse> loads = world.physics().contact_impulses();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_EQ(loads[0].body_tag, 7u);
  EXPECT_EQ(loads[0].shape_tag, 3u);
  EXPECT_LT((loads[0].impulse_W - Vec3(0, -mass * 9.81 * dt, 0)).norm(), 0.01 * mass * 9.81 * dt);
  EXPECT_LT((loads[0].point_W - Vec3(0.5, 1, 0.25)).norm(), 0.02);
}

TEST(RigidPhysics, AFrozenBodyActsAsAStaticOne) {
  RigidWorld world(weightless());
  const BodyId box = world.add(W::box(Vec3::Ones(), Vec3::Zero(), 1));
  world.physics().apply_impulse(box, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0),
                                Vec3::Zero());
  world.step(1.0 / 60, 2);
  const BodyId ball = world.add(W::moving(W::sphere(0.5, Vec3(-1.2, 0, 0)), Vec3(5, 0, 0)));
  world.run(0.2, 1.0 / 60, 2);
  EXPECT_LT(world.state(ball).velocity_W.norm(), 1e-3);
  EXPECT_TRUE(world.state(box).X_WB.position.isZero());
}

TEST(RigidPhysics, AccountsForTheMomentumOfARebound) {
  RigidWorld world;
  world.add(W::with_friction(W::ground(), 0.5, 0.8));
  const BodyDesc ball = W::with_friction(W::sphere(0.5, Vec3(0, 0.7, 0)), 0.5, 0.8);
  world.add(W::moving(ball, Vec3(2, -3, 0)));
  bool rebounds = false;
  for (int i = 0; i < 30; ++i) {
    const SolveReport report = world.step(1.0 / 60, 4);
    const Vec3 unexplained_Ns =
        report.momentum_after_Ns - report.momentum_before_Ns - report.external_impulse_Ns;
    EXPECT_LT(unexplained_Ns.norm(), 1e-5 * 3 * ball.mass_kg) << i;
    EXPECT_DOUBLE_EQ(report.mass_kg, ball.mass_kg);
    rebounds |= world.momentum().y() > 0;
  }
  EXPECT_TRUE(rebounds);
}

TEST(RigidPhysics, AnImpulseOnABodyAtRestIsSeenByTheNextCollide) {
  RigidWorld world(weightless());
  world.add(W::fixed(W::box(Vec3::Ones(), Vec3(1.2, 0, 0))));
  const BodyDesc box = W::box(Vec3::Ones(), Vec3::Zero());
  const BodyId id = world.add(box);
  world.run(0.1, 1.0 / 60, 2);
  world.physics().collide(1.0 / 60);
  EXPECT_TRUE(world.physics().speculative_contacts().empty());
  world.physics().apply_impulse(id, Vec3(20 * box.mass_kg, 0, 0), Vec3::Zero());
  world.physics().collide(1.0 / 60);
  EXPECT_EQ(world.physics().speculative_contacts().size(), 1u);
}

TEST(RigidPhysics, AHalfSpaceGoesThroughItsPointForAnyRotationOfItsBody) {
  RigidWorld world;
  BodyDesc ground = W::ground(Vec3::UnitX());
  ground.X_WB.position = Vec3(0, 3, 0);
  ground.X_WB.rotation = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()));
  ground.shapes[0].center_R = Vec3(2, -5, 0);  // (5, 5, 0) in W
  world.add(ground);
  const BodyId box = world.add(W::box(Vec3::Ones(), Vec3(0, 5.6, 0)));
  world.run(1, 1.0 / 60, 4);
  EXPECT_NEAR(world.state(box).X_WB.position.y(), 5.5, 1e-3);
}

}  // namespace
}  // namespace sunder::solver
