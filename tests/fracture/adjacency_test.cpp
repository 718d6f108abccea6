// Tests of contacts between convexes, islands, and overlaps of polygons.
#include "fracture/adjacency/adjacency.h"

#include <gtest/gtest.h>

#include "engine/base/trigonometry.h"
#include "fracture/adjacency/islands.h"
#include "fracture/adjacency/polygon.h"
#include "fracture/adjacency/polygon_overlap.h"
#include "fracture/cut/convex_distance.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

void expect_same(const std::vector<Bond>& found, const std::vector<Bond>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].a, expected[i].a);
    EXPECT_EQ(found[i].b, expected[i].b);
    EXPECT_EQ(found[i].face_a, expected[i].face_a);
    EXPECT_EQ(found[i].face_b, expected[i].face_b);
    EXPECT_NEAR(found[i].area_m2, expected[i].area_m2, 1e-12 + 1e-9 * expected[i].area_m2);
  }
}

TEST(Adjacency, of_a_grid_is_its_inner_faces_with_their_areas) {
  const Compound grid = grid_compound(5, 4, 3, Vec3(0.3, 0.2, 0.1));
  EXPECT_EQ(grid.bonds.size(), 4u * 4 * 3 + 5 * 3 * 3 + 5 * 4 * 2);
  double area = 0;
  for (const Bond& bond : grid.bonds) area += bond.area_m2;
  EXPECT_NEAR(area, 48 * .02 + 45 * .03 + 40 * .06, 1e-12);
}

TEST(Adjacency, agrees_with_the_papers_sort_by_distance) {
  const Compound voronoi = voronoi_compound(200, 1);
  ASSERT_GT(voronoi.bonds.size(), 900u);
  expect_same(voronoi.bonds, contacts_by_distance(voronoi, 1e-9));
  const Compound grid = grid_compound(4, 5, 3);
  expect_same(grid.bonds, contacts_by_distance(grid, 1e-9));
}

TEST(Adjacency, counts_only_the_part_that_overlaps) {
  const Compound pair =
      make_compound({{make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), MaterialIndex(0u), 0},
                     {make_box(Vec3(0.75, 1, 0.5), Vec3(2, 2, 2)), MaterialIndex(0u), 0},
                     {make_box(Vec3(1, 0, 1), Vec3(2, 1, 2)), MaterialIndex(0u), 0}});
  ASSERT_EQ(pair.bonds.size(), 2u);  // Boxes 0 and 2 share an edge only.
  EXPECT_NEAR(pair.bonds[0].area_m2, 0.125, 1e-15);
  EXPECT_NEAR(pair.bonds[1].area_m2, 1, 1e-15);
}

TEST(Islands, are_those_of_brute_force) {
  Random random(9);
  for (int round = 0; round < 50; ++round) {
    const std::size_t count = 2 + random.below(40);
    std::vector<Bond> bonds;
    for (std::uint32_t i = 0; i < count / 2; ++i) {
      const auto a = random.below(static_cast<std::uint32_t>(count));
      const auto b = random.below(static_cast<std::uint32_t>(count));
      if (a != b) bonds.push_back({std::min(a, b), std::max(a, b), 0, 0, 1});
    }
    std::vector<std::uint32_t> label(count);
    for (std::uint32_t i = 0; i < count; ++i) label[i] = i;
    for (std::size_t pass = 0; pass < count; ++pass) {
      for (const Bond& bond : bonds) {
        label[bond.a] = label[bond.b] = std::min(label[bond.a], label[bond.b]);
      }
    }
    const std::vector<std::uint32_t> islands = find_islands(count, bonds);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_EQ(islands[i] == islands[j], label[i] == label[j]);
      }
    }
  }
}

TEST(Polygon, overlap_of_squares_is_the_common_rectangle) {
  const std::vector<Vec2> a{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<Vec2> b{{.5, .25}, {2, .25}, {2, 2}, {.5, 2}};
  const std::span<const Vec2> only_a[] = {a}, only_b[] = {b};
  OverlapScratch scratch;
  EXPECT_DOUBLE_EQ(overlap_area(a, b, scratch), .375);
  EXPECT_DOUBLE_EQ(overlap_area(b, a, scratch), .375);
  EXPECT_DOUBLE_EQ(overlap_area(only_a, only_b, 0), .375);
}

TEST(Polygon, overlap_of_any_polygons_is_that_of_their_convex_parts) {
  Random random(6);
  OverlapScratch scratch;
  for (int round = 0; round < 200; ++round) {
    // A star, which a fan from its middle divides into triangles, and a triangle with a hole.
    std::vector<Vec2> star;
    for (int i = 0; i < 9; ++i) {
      const SinCos angle = sin_cos(2 * 3.14159265358979 * i / 9);
      star.push_back(random.uniform(.2, 1) * Vec2(angle.cos, angle.sin));
    }
    const Vec2 shift(random.uniform(-1, 1), random.uniform(-1, 1));
    const std::vector<Vec2> outer{Vec2(-1, -.9) + shift, Vec2(1, -.8) + shift, Vec2(0, 1) + shift};
    const std::vector<Vec2> hole{.3 * outer[0] + .7 * shift, .3 * outer[2] + .7 * shift,
                                 .3 * outer[1] + .7 * shift};
    const std::vector<Vec2> filled{hole[0], hole[2], hole[1]};
    double expected = 0;
    for (std::size_t i = 0; i < star.size(); ++i) {
      const std::vector<Vec2> part{Vec2::Zero(), star[i], star[(i + 1) % star.size()]};
      expected += overlap_area(part, outer, scratch) - overlap_area(part, filled, scratch);
    }
    const std::span<const Vec2> a[] = {star}, b[] = {outer, hole};
    ASSERT_NEAR(overlap_area(a, b, 0), expected, 1e-14);
    ASSERT_NEAR(overlap_area(b, a, 0), expected, 1e-14);
    // The overlap of polygons that differ by rounding is the whole, with and without a tolerance.
    std::vector<Vec2> rounded = outer;
    for (Vec2& point : rounded) point += 1e-15 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
    const std::span<const Vec2> c[] = {hole, rounded};
    const double area = polygon_area(outer) + polygon_area(hole);
    ASSERT_NEAR(overlap_area(b, c, 1e-12), area, 1e-14);
    ASSERT_NEAR(overlap_area(b, c, 0), area, 1e-14);
  }
}

TEST(Polygon, overlap_of_a_triangle_and_a_dart_on_its_corners_is_the_dart) {
  const std::vector<Vec2> triangle{{0, 0}, {4, 0}, {0, 4}};
  const std::vector<Vec2> dart{{0, 0}, {4, 0}, {0, 4}, {1, 1}};
  const std::span<const Vec2> a[] = {triangle}, b[] = {dart};
  EXPECT_NEAR(overlap_area(a, b, 1e-12), 6, 1e-12);
  EXPECT_NEAR(overlap_area(b, a, 1e-12), 6, 1e-12);
}

TEST(Polygon, overlap_of_equal_polygons_up_to_rounding_is_the_whole) {
  const std::vector<Vec2> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  // The same square, from another corner on.
  std::vector<Vec2> moved{{1, 1}, {0, 1}, {0, 0}, {1, 0}};
  for (Vec2& point : moved) point.x() += 1e-3;
  const std::span<const Vec2> a[] = {square}, b[] = {moved};
  EXPECT_EQ(overlap_area(a, b, 2e-3), 1);
  EXPECT_NEAR(overlap_area(a, b, 1e-4), 0.999, 1e-12);
}

TEST(Polygon, overlap_of_a_polygon_and_itself_with_a_hole_lacks_the_hole) {
  const std::vector<Vec2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<Vec2> hole{{1, 1}, {1, 3}, {3, 3}, {3, 1}};
  const std::span<const Vec2> filled[] = {square}, open[] = {square, hole};
  EXPECT_NEAR(overlap_area(filled, open, 1e-9), 12, 1e-12);
  EXPECT_NEAR(overlap_area(open, filled, 1e-9), 12, 1e-12);
}

TEST(Polygon, distance_to_a_box_is_that_of_its_nearest_point) {
  const ConvexPolyhedron box = make_box(Vec3(0, 0, 0), Vec3(1, 2, 3));
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 point(random.uniform(-3, 4), random.uniform(-3, 5), random.uniform(-3, 6));
    const Vec3 nearest = point.cwiseMax(Vec3(0, 0, 0)).cwiseMin(Vec3(1, 2, 3));
    EXPECT_NEAR(distance(point, box), (point - nearest).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace sunder::fracture
