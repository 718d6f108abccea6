// Tests of structures: closed, without overlaps, bonded where they touch.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

std::vector<Solid> solids(const std::string& lines) {
  return parse_scene("[scene]\ndescription = \"x\"\n[[solid]]\n" + lines, "x.toml", {}).solids;
}

/// Returns true if bonds join all convexes.
bool is_connected(const Compound& compound) {
  std::vector<std::size_t> root(compound.convexes.size());
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i];
    return i;
  };
  for (const Bond& bond : compound.bonds) root[find(bond.a)] = find(bond.b);
  std::set<std::size_t> roots;
  for (std::size_t i = 0; i < root.size(); ++i) roots.insert(find(i));
  return roots.size() == 1;
}

/// Returns the volume that two axis-aligned boxes share.
double overlap(const Box& a, const Box& b) {
  const Vec3 extent = a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min);
  return (extent.array() > 0).all() ? extent.prod() : 0;
}

TEST(Structures, AWallHasTwentyCoursesOfTwentyFiveBodies) {
  const std::vector<Solid> wall = solids("structure = \"brick_wall\"");
  ASSERT_EQ(wall.size(), 500u);
  double volume_m3 = 0;
  for (const Solid& brick : wall) volume_m3 += volume(brick.compound);
  EXPECT_NEAR(volume_m3, 24.5 * 0.4 * 20 * 0.2 * 0.2, 1e-9);
}

TEST(Structures, NoJointOfAWallLiesOverAnother) {
  const std::vector<Solid> wall = solids("structure = \"brick_wall\"\nbricks = 6\ncourses = 2");
  std::vector<std::set<long>> joints(2);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const double left = wall[i].X_WR.position.x() + bounds(wall[i].compound).min.x();
    if (i % 6 != 0) joints[i / 6].insert(std::lround(1e6 * left));
  }
  for (const long joint : joints[0]) EXPECT_FALSE(joints[1].contains(joint));
}

TEST(Structures, AWallMixesTwoMaterials) {
  const std::vector<Solid> wall = solids(
      "structure = \"brick_wall\"\nmaterial = \"clay\"\nsecond = \"wood\"\n"
      "second_share = 0.4");
  std::set<MaterialIndex> materials;
  for (const Solid& brick : wall) materials.insert(brick.compound.convexes[0]->material);
  EXPECT_EQ(materials.size(), 2u);
}

TEST(Structures, AHouseIsOneConnectedCompoundWithoutOverlaps) {
  const std::vector<Solid> house = solids("structure = \"house\"\nanchored = \"bottom\"");
  ASSERT_EQ(house.size(), 1u);
  const Compound& compound = house[0].compound;
  EXPECT_TRUE(is_connected(compound));
  EXPECT_TRUE(compound.is_anchored());
  for (std::size_t i = 0; i < compound.convexes.size(); ++i) {
    EXPECT_TRUE(is_closed(compound.convexes[i]->polyhedron));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_LT(overlap(compound.convexes[i]->box, compound.convexes[j]->box), 1e-9)
          << i << " and " << j;
    }
  }
}

TEST(Structures, AHouseHasBrickAndConcreteAndHolesForWindows) {
  const Scene scene =
      parse_scene("[scene]\ndescription = \"x\"\n[[solid]]\nstructure = \"house\"\n", "x.toml", {});
  const Compound& house = scene.solids[0].compound;
  std::set<std::string> names;
  for (const ConvexPtr& convex : house.convexes) {
    names.insert(scene.materials[convex->material.value].name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"brick", "concrete"}));
  const Vec3 size = bounds(house).extent();
  EXPECT_LT(volume(house), 0.3 * size.prod()) << "it is hollow";
}

TEST(Structures, AColumnIsAClosedPrismOfTheRightVolume) {
  const std::vector<Solid> column =
      solids("structure = \"column\"\nradius_m = 0.5\nheight_m = 2\nsides = 64");
  const ConvexPolyhedron& prism = column[0].compound.convexes[0]->polyhedron;
  EXPECT_TRUE(is_closed(prism));
  EXPECT_NEAR(volume(column[0].compound), 64 * 0.25 * std::sin(2 * M_PI / 64), 1e-9);
}

TEST(Structures, GlassIsInAnAnchoredFrame) {
  const std::vector<Solid> pane = solids("structure = \"pane\"");
  const Compound& compound = pane[0].compound;
  ASSERT_EQ(compound.convexes.size(), 5u);
  EXPECT_TRUE(is_connected(compound));
  EXPECT_EQ(compound.anchored, (std::vector<std::uint8_t>{0, 1, 0, 0, 0})) << "by its foot";
  EXPECT_FALSE(solids("structure = \"pane\"\nframe_m = 0")[0].compound.is_anchored());
}

TEST(Structures, AHallIsOneFrameOfSteelOnAnchoredFeetUnderLooseSlabs) {
  const std::vector<Solid> hall = solids("structure = \"hall\"");
  ASSERT_EQ(hall.size(), 1u + 3 * 4 * 5) << "slabs: in three bays four by five";
  const Compound& steel = hall[0].compound;
  EXPECT_TRUE(is_connected(steel));
  EXPECT_EQ(std::ranges::count(steel.anchored, 0), std::ssize(steel.convexes) - 8) << "feet";
  EXPECT_FALSE(hall[1].compound.is_anchored());
  for (std::size_t i = 0; i < steel.convexes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_LT(overlap(steel.convexes[i]->box, steel.convexes[j]->box), 1e-9) << i << " and " << j;
  EXPECT_EQ(solids("structure = \"hall\"\nroof_m = 0").size(), 1u);
}

TEST(Structures, APaneFallsWhenTheAnchorOfItsFootIsRemoved) {
  const Scene scene = parse_scene(
      "[scene]\ndescription = \"x\"\nduration_s = 0.5\n"
      "[[solid]]\nstructure = \"pane\"\nposition = [0, 4, 0]\n"
      "[[script.remove]]\ntime_s = 0.1\nfrom = [-9, 3.9, -9]\nto = [9, 4.2, 9]\n",
      "x.toml", {});
  const auto simulation = make_simulation(scene);
  FramePtr last = simulation->next();
  ASSERT_EQ(last->bodies.size(), 1u);
  EXPECT_TRUE(last->bodies[0].is_static);
  const double before = last->bodies[0].X_WB.position.y();
  while (FramePtr frame = simulation->next()) last = std::move(frame);
  for (const FrameBody& body : last->bodies) {
    EXPECT_LT(body.X_WB.position.y(), before - 0.5) << "0.4 s of fall";
  }
}

TEST(Structures, AStackIsSeparateBodies) {
  const std::vector<Solid> stack = solids("structure = \"stack\"\ncount = 3\nsize_m = [1, 2, 1]");
  ASSERT_EQ(stack.size(), 3u);
  EXPECT_DOUBLE_EQ(stack[2].X_WR.position.y(), 4);
}

}  // namespace
}  // namespace sunder::scenes
