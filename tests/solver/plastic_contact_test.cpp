// Tests of bodies in plastic joints among contacts: shapes that do not collide, sleep, equal bits.
#include <array>
#include <bit>
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "tests/solver/plastic_joints.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

/// A girder of two halves from a wall; it bends at the middle, where its non-colliding shapes
/// overlap, and falls to the ground.
struct Girder {
  Frame frame;
  BodyId wall, near, far;

  explicit Girder(bool sleeps = false, double height_m = 0.6) : frame(Vec3(0, -kG, 0), sleeps) {
    RigidWorld& world = frame.world;
    wall = world.add(W::ground());
    const auto half = [&](double from_m) {
      BodyDesc body = W::box(Vec3(2, 0.2, 0.2), Vec3(from_m + 1, height_m, 0));
      body.shapes.clear();
      for (int i = 0; i < 4; ++i) {
        ShapeDesc shape;
        shape.hull = cell_at(-0.75 + 0.5 * i);
        shape.tag = static_cast<std::uint32_t>(i);
        body.shapes.push_back(shape);
      }
      return world.add(body);
    };
    near = half(0), far = half(2);
    JointDesc root = plastic_at(world, {}, near, Vec3(0, height_m, 0), strength(3e4));
    frame.joints.push_back(world.physics().join(root));
    JointDesc middle = plastic_at(world, near, far, Vec3(2, height_m, 0), strength(400));
    middle.quiet_a = {3}, middle.quiet_b = {0};
    frame.joints.push_back(world.physics().join(middle));
    frame.flowed.resize(2);
  }
  static const ConvexPolyhedron* cell_at(double x_m) {
    return W::keep(make_box(Vec3(x_m - 0.25, -0.1, -0.1), Vec3(x_m + 0.25, 0.1, 0.1)));
  }
  double tip_m() const { return (frame.world.state(far).X_WB * Vec3(1, 0, 0)).y(); }
};

TEST(PlasticContact, AGirderFallsToTheGroundWhileItYields) {
  Girder girder;
  double deepest = 0, least_W = 0;
  RigidWorld& world = girder.frame.world;
  double before = world.kinetic_energy() + world.potential_energy(kG), rise = 0;
  for (int i = 0; i < 240; ++i) {
    const double W_before = girder.frame.work_J;
    girder.frame.step(4);
    least_W = std::min(least_W, girder.frame.work_J - W_before);
    deepest = std::max(deepest, 0.1 - girder.tip_m());
    const double now = world.kinetic_energy() + world.potential_energy(kG) + girder.frame.work_J;
    rise = std::max(rise, now - before);
    before = std::min(before, now);
  }
  std::printf("girder: tip at %.3f m, flowed %.3f rad, W %.1f J, motion and work rise by %.2f J\n",
              girder.tip_m(), girder.frame.flowed[1].turn_R.z(), girder.frame.work_J, rise);
  EXPECT_GT(-girder.frame.flowed[1].turn_R.z(), 0.1);
  EXPECT_EQ(girder.frame.flowed[0].work_J, 0) << "the root holds";
  EXPECT_LT(deepest, 0.2);
  EXPECT_EQ(least_W, 0);
  EXPECT_LT(rise, 0.05 * girder.frame.work_J);
  EXPECT_LT(world.kinetic_energy(), 1e-3);
}

TEST(PlasticContact, BodiesAtRestInPlasticJointsSleepAndDoNotFlow) {
  Girder girder(true);
  girder.frame.run(5, 4);
  EXPECT_TRUE(girder.frame.world.state(girder.near).asleep);
  EXPECT_TRUE(girder.frame.world.state(girder.far).asleep);
  const double turn = girder.frame.flowed[1].turn_R.z(), tip = girder.tip_m();
  girder.frame.world.physics().apply_impulse(girder.far, Vec3(0, 1, 0), Vec3(3, 0.5, 0));
  girder.frame.run(5, 4);
  EXPECT_NEAR(girder.frame.flowed[1].turn_R.z(), turn, 1e-4);
  EXPECT_NEAR(girder.tip_m(), tip, 1e-3);
  EXPECT_TRUE(girder.frame.world.state(girder.far).asleep);
}

TEST(PlasticContact, NonCollidingShapesIgnoreTheOtherBodyOnly) {
  const auto two = [](std::vector<std::uint32_t> quiet_a, std::vector<std::uint32_t> quiet_b) {
    RigidWorld world(awake(Vec3::Zero()));
    BodyDesc a = W::box(Vec3(1, 1, 1), Vec3::Zero()), b = W::box(Vec3(1, 1, 1), Vec3(0.9, 0, 0));
    a.shapes[0].tag = 5, b.shapes[0].tag = 6;
    const BodyId body_a = world.add(a), body_b = world.add(b);
    BodyDesc third = W::box(Vec3(1, 1, 1), Vec3(-0.9, 0, 0));
    third.shapes[0].tag = 6;
    world.add(third);
    JointDesc joint = plastic_at(world, body_a, body_b, Vec3(0.45, 0, 0), strength(1e6));
    joint.quiet_a = quiet_a, joint.quiet_b = quiet_b;
    const JointId id = world.physics().join(joint);
    const std::uint32_t before = world.step(kPlasticDt_s, 4).contacts;
    world.physics().attach(id, true, body_a, {});
    world.physics().attach(id, false, body_b, {});
    const std::uint32_t after = world.step(kPlasticDt_s, 4).contacts;
    const std::uint32_t tag = 5;
    world.physics().attach(id, true, body_a, std::span(&tag, 1));
    const std::uint32_t again = world.step(kPlasticDt_s, 4).contacts;
    world.physics().cut(id);
    return std::array{before, after, again, world.step(kPlasticDt_s, 4).contacts};
  };
  EXPECT_EQ(two({}, {}), (std::array{2u, 2u, 1u, 2u})) << "the third is touched in any case";
  EXPECT_EQ(two({5}, {}), (std::array{1u, 2u, 1u, 2u}));
  EXPECT_EQ(two({}, {6}), (std::array{1u, 2u, 1u, 2u}));
  EXPECT_EQ(two({6}, {5}), (std::array{2u, 2u, 1u, 2u}));
}

TEST(PlasticContact, AnEndMovesToAnotherBodyAndGoesOnYielding) {
  const BodyDesc bar = W::box(Vec3(2, 0.2, 0.2), Vec3(1, 0, 0));
  const double g = 1.2 * kMoment_Nm / bar.mass_kg;
  Frame whole(Vec3(0, -g, 0)), moved(Vec3(0, -g, 0));
  for (Frame* frame : {&whole, &moved}) {
    const BodyId id = frame->world.add(bar);
    frame->join({}, id, Vec3::Zero());
    frame->run(0.2, 4);
  }
  const BodyState state = moved.world.state(moved.world.id(0));
  BodyDesc next = W::moving(bar, state.velocity_W, state.angular_velocity_W);
  next.X_WB = state.X_WB;
  const BodyId id = moved.world.replace({moved.world.id(0)}, {next}).front();
  moved.world.physics().attach(moved.joints[0], false, id);
  whole.run(0.2, 4), moved.run(0.2, 4);
  EXPECT_GT(angle(whole.world, whole.world.id(0)), 0.05);
  EXPECT_NEAR(angle(moved.world, id), angle(whole.world, whole.world.id(0)), 1e-6);
  EXPECT_NEAR(moved.work_J, whole.work_J, 1e-3);
}

TEST(PlasticContact, AHardenedJointBearsMore) {
  const BodyDesc bar = W::box(Vec3(2, 0.2, 0.2), Vec3(1, 0, 0));
  Frame frame(Vec3(0, -1.1 * kMoment_Nm / bar.mass_kg, 0));
  const BodyId id = frame.world.add(bar);
  frame.join({}, id, Vec3::Zero());
  frame.run(0.2, 4);
  EXPECT_GT(angle(frame.world, id), 1e-3);
  frame.world.physics().strengthen(frame.joints[0], strength(1.3 * kMoment_Nm));
  frame.run(0.2, 4);
  const double turn = angle(frame.world, id), work_J = frame.work_J;
  frame.run(2, 4);
  EXPECT_EQ(frame.work_J, work_J);
  EXPECT_NEAR(angle(frame.world, id), turn, 1e-4);
}

TEST(PlasticContact, GivesTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes;
  const int before = threads();
  for (const int count : {1, 2, 7}) {
    set_threads(count);
    Frame frame(Vec3(0, -kG, 0), true);
    frame.world.add(W::ground());
    for (int i = 0; i < 12; ++i) {
      BodyId last;
      for (int k = 0; k < 6; ++k) {
        const BodyId next =
            frame.world.add(W::box(Vec3(0.5, 0.2, 0.2), Vec3(0.25 + 0.5 * k, 1, 0.15 * i)));
        frame.join(last, next, Vec3(0.5 * k, 1, 0.15 * i), strength(100 + 50 * i));
        last = next;
      }
    }
    frame.run(1, 4);
    hashes.push_back(combine(frame.world.hash(), std::bit_cast<std::uint64_t>(frame.work_J)));
    EXPECT_GT(frame.work_J, 0);
  }
  set_threads(before);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace sunder::solver
