// Tests of edits of a static compound: remaining shapes keep their contacts, and the cost follows
// from the number of changed shapes.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::edit_test {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 60;

/// side³ touching cubes of 0.2 m as one static body; tags count from 0, x fastest.
struct CubeCompound {
  std::vector<ConvexPolyhedron> hulls;
  BodyDesc desc;

  explicit CubeCompound(int side) {
    const Vec3 size(0.2, 0.2, 0.2);
    for (int i = 0; i < side * side * side; ++i) {
      const Vec3 low = 0.2 * Vec3(i % side, i / side / side, i / side % side);
      hulls.push_back(make_box(low, low + size));
    }
    desc.is_static = true;
    for (std::size_t i = 0; i < hulls.size(); ++i) {
      ShapeDesc shape;
      shape.hull = &hulls[i];
      shape.tag = static_cast<std::uint32_t>(i);
      desc.shapes.push_back(shape);
    }
  }
};

double cpu_us() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

TEST(Edit, BodiesOnRemainingShapesAreNotMovedAndNotWoken) {
  CubeCompound compound(5);
  RigidWorld world;
  const BodyId block = world.add(compound.desc);
  const BodyId box_on_remaining = world.add(W::box(Vec3(0.15, 0.15, 0.15), Vec3(0.1, 1.075, 0.1)));
  const BodyId box_on_removed = world.add(W::box(Vec3(0.15, 0.15, 0.15), Vec3(0.9, 1.075, 0.9)));
  world.run(2, kDt_s, 4);
  ASSERT_TRUE(world.state(box_on_remaining).asleep && world.state(box_on_removed).asleep);
  const BodyState before = world.state(box_on_remaining);
  // A corner of the top layer, and two cubes inside.
  const std::vector<std::uint32_t> gone = {124, 60, 61};
  world.physics().edit({block, gone, {}});
  EXPECT_FALSE(world.state(box_on_removed).asleep);
  world.run(0.3, kDt_s, 4);
  EXPECT_LT(world.state(box_on_removed).X_WB.position.y(), 0.95);
  EXPECT_TRUE(world.state(box_on_remaining).asleep);
  EXPECT_EQ(world.state(box_on_remaining).X_WB.position, before.X_WB.position);
}

TEST(Edit, ContactsOfRemainingShapesKeepTheirImpulses) {
  // The slab lies on cubes that stay and on cubes that are removed; its contacts with the former
  // keep their impulses.
  CubeCompound compound(4);
  RigidOptions options;
  options.sleeping = false;
  RigidWorld world(options);
  const BodyId block = world.add(compound.desc);
  const BodyId slab = world.add(W::box(Vec3(0.8, 0.1, 0.8), Vec3(0.4, 0.85, 0.4)));
  world.run(1, kDt_s, 4);
  // The middle of the top layer.
  const std::vector<std::uint32_t> gone = {48 + 5, 48 + 6, 48 + 9, 48 + 10};
  world.physics().edit({block, gone, {}});
  world.run(0.5, kDt_s, 4);
  EXPECT_LT(world.state(slab).velocity_W.norm(), 1e-3);
  EXPECT_NEAR(world.state(slab).X_WB.position.y(), 0.85, 1e-3);
}

TEST(Edit, AddedShapesCollideAndKeepTheirTags) {
  CubeCompound compound(3);
  RigidWorld world;
  const BodyId block = world.add(compound.desc);
  const BodyId box = world.add(W::box(Vec3(0.2, 0.2, 0.2), Vec3(1.1, 1.5, 0.1)));
  const ConvexPolyhedron shelf_hull = make_box(Vec3(0.6, 0.5, 0), Vec3(1.4, 0.6, 0.4));
  ShapeDesc shelf;
  shelf.hull = &shelf_hull;
  shelf.tag = 1000;
  world.physics().edit({block, {}, std::span(&shelf, 1)});
  world.run(2, kDt_s, 4);
  EXPECT_NEAR(world.state(box).X_WB.position.y(), 0.7, 2e-3);
  const std::vector<std::uint32_t> gone = {1000};
  world.physics().edit({block, gone, {}});
  world.run(0.3, kDt_s, 4);
  EXPECT_LT(world.state(box).X_WB.position.y(), 0.6);
}

TEST(Edit, IsTheSameAsABodyMadeWithoutTheRemovedShapes) {
  std::vector<double> heights;
  for (const bool edited : {true, false}) {
    CubeCompound compound(4);
    std::vector<std::uint32_t> gone;
    for (std::uint32_t tag = 32; tag < 64; ++tag)
      if (tag % 3 == 0) gone.push_back(tag);
    RigidWorld world;
    if (!edited)
      std::erase_if(compound.desc.shapes,
                    [](const ShapeDesc& s) { return s.tag >= 32 && s.tag % 3 == 0; });
    const BodyId block = world.add(compound.desc);
    if (edited) {
      world.step(kDt_s, 4);
      world.physics().edit({block, gone, {}});
    }
    const BodyId ball = world.add(W::sphere(0.09, Vec3(0.31, 1.3, 0.33)));
    world.run(3, kDt_s, 4);
    heights.push_back(world.state(ball).X_WB.position.y());
  }
  EXPECT_NEAR(heights[0], heights[1], 1e-9);
}

TEST(Edit, FiftyOfTwentyThousandConvexesAreRemovedInLessThanATenthOfABuild) {
  CubeCompound compound(27);
  RigidWorld world;
  for (int i = 0; i < 200; ++i)
    world.add(
        W::box(Vec3(0.1, 0.1, 0.1), Vec3(0.2 + 0.25 * (i % 20), 5.46, 0.2 + 0.25 * (i / 20))));
  const double before_us = cpu_us();
  const BodyId block = world.add(compound.desc);
  world.step(kDt_s, 1);
  const double build_us = cpu_us() - before_us;
  world.run(0.2, kDt_s, 1);
  double least_us = 1e9, collide_us = 1e9;
  for (std::uint32_t round = 0; round < 10; ++round) {
    std::vector<std::uint32_t> gone(50);
    std::iota(gone.begin(), gone.end(), 19683 - 50 * (round + 1));
    const double start_us = cpu_us();
    world.physics().edit({block, gone, {}});
    const double edit_us = cpu_us();
    world.physics().collide(kDt_s);
    least_us = std::min(least_us, edit_us - start_us);
    collide_us = std::min(collide_us, cpu_us() - edit_us);
    world.physics().solve(kDt_s, 1);
  }
  std::printf(
      "19,683 convexes: made and collided in %.0f us; 50 leave in %.1f us, then collide "
      "%.0f us\n",
      build_us, least_us, collide_us);
  EXPECT_LT(least_us, 0.1 * build_us);
}

TEST(Edit, GivesTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes;
  for (const int count : {1, 2, 4, 7}) {
    set_threads(count);
    CubeCompound compound(8);
    RigidWorld world;
    const BodyId block = world.add(compound.desc);
    for (int i = 0; i < 100; ++i)
      world.add(W::box(Vec3(0.15, 0.15, 0.15),
                       Vec3(0.1 + 0.16 * (i % 10), 1.8 + 0.1 * (i % 3), 0.1 + 0.16 * (i / 10))));
    for (std::uint32_t i = 0; i < 60; ++i) {
      world.step(kDt_s, 4);
      const std::uint32_t gone = 511 - 3 * i;
      world.physics().edit({block, std::span(&gone, 1), {}});
    }
    hashes.push_back(world.hash());
  }
  set_threads(0);
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

/// Stacks of four cubes at rest; those of each second stack are joined, each to the one below.
struct Stacks {
  RigidWorld world;
  std::vector<JointId> joints;

  explicit Stacks(int count) {
    world.add(W::ground());
    for (int i = 0; i < 4 * count; ++i) {
      const double place = i / 4, layer = i % 4;
      const Vec3 at(0.5 * std::fmod(place, 40), 0.1 + 0.2 * layer, 0.5 * std::floor(place / 40));
      const BodyId cube = world.add(W::box(Vec3::Constant(0.2), at));
      if (i / 4 % 2 == 0 || i % 4 == 0) continue;
      joints.push_back(world.physics().join(joint_at(
          world, JointKind::kFixed, world.id(world.size() - 2), cube, at - Vec3(0, 0.1, 0))));
    }
    world.run(2, kDt_s, 4);
    world.physics().take_work();
  }
  BodyId cube(int stack, int layer) const {
    return world.id(static_cast<std::size_t>(1 + 4 * stack + layer));
  }
  std::uint64_t contacts_looked_at() {
    std::uint64_t sum = 0;
    for (const WorkItem& item : world.physics().take_work())
      if (std::string_view(item.name) == "contacts of changed bodies") sum += item.count;
    return sum;
  }
  std::ptrdiff_t awake() {
    return std::ranges::count(world.physics().states().mode, BodyMode::kAwake);
  }
};

TEST(Edit, AChangeLooksAtTheNeighboursOfTheBodyInAWorldOfAnySize) {
  std::vector<std::vector<std::uint64_t>> all;
  for (const int count : {200, 2000}) {
    Stacks stacks(count);
    std::vector<std::uint64_t>& looked_at = all.emplace_back();
    std::ptrdiff_t before = stacks.awake();
    EXPECT_EQ(before, 0);
    const auto woken = [&] {
      looked_at.push_back(stacks.contacts_looked_at());
      return stacks.awake() - std::exchange(before, stacks.awake());
    };
    stacks.world.remove(stacks.cube(2, 1));
    EXPECT_EQ(woken(), 3);  // what it bore and what bore it
    stacks.world.replace({stacks.cube(4, 2)}, {W::box(Vec3::Constant(0.2), Vec3(2, 9, 0))});
    EXPECT_EQ(woken(), 3);                   // with the new one
    stacks.world.remove(stacks.cube(3, 1));  // in joints
    EXPECT_EQ(woken(), 2);
    stacks.world.physics().cut(stacks.joints[6]);  // between the lowest two of stack 5
    EXPECT_EQ(woken(), 2);
    stacks.world.physics().join(joint_at(stacks.world, JointKind::kFixed, stacks.cube(6, 0),
                                         stacks.cube(6, 1), Vec3(1, 0.2, 0)));
    EXPECT_EQ(woken(), 2);
    for (const std::uint64_t number : looked_at) EXPECT_LT(number, 20u);
  }
  EXPECT_EQ(all[0], all[1]);
}

}  // namespace
}  // namespace sunder::solver::edit_test
