// Tests that patterns tile their box, and of their numbers and sizes of cells.
#include "fracture/pattern/pattern.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/hash.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

void expect_tiling(const Pattern& pattern) {
  double volume = 0;
  for (const Cell& cell : pattern.cells) {
    EXPECT_TRUE(is_closed(cell.polyhedron));
    EXPECT_GT(cell.volume, 0);
    volume += cell.volume;
    for (const auto& face : cell.polyhedron.faces) {
      const Plane& stored = pattern.planes.at(plane_index(face.id));
      const double side = plane_flipped(face.id) ? -1 : 1;
      EXPECT_EQ((stored.normal - side * face.plane.normal).norm(), 0);
    }
  }
  EXPECT_NEAR(volume / std::pow(2 * Pattern::kHalfExtent, 3), 1, 1e-12);
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 point = 1.5 * random.uniform() * random.direction();
    int count = 0;
    for (const Cell& cell : pattern.cells) count += contains(cell.polyhedron, point);
    EXPECT_EQ(count, 1);
  }
}

TEST(Pattern, of_voronoi_cells_tiles_its_box) {
  const Pattern pattern = voronoi_pattern(100, 2, false, 1);
  EXPECT_GE(pattern.cells.size(), 100u);
  expect_tiling(pattern);
}

TEST(Pattern, of_a_web_tiles_its_box) {
  const Pattern pattern = web_pattern(6, 12, 0.3, 1);
  EXPECT_EQ(pattern.cells.size(), 7u * 12);
  expect_tiling(pattern);
}

TEST(Pattern, of_a_web_ends_a_tenth_beyond_its_radius_at_most) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    double farthest = 0;
    for (const Cell& cell : web_pattern(2, 24, 1, seed).cells) {
      if (cell.outer) continue;
      for (const Vec3& v : cell.polyhedron.vertices) {
        farthest = std::max(farthest, std::hypot(v.x(), v.z()));
      }
    }
    EXPECT_GT(farthest, 1);
    EXPECT_LE(farthest, 1.1 + 1e-9);
  }
}

TEST(Pattern, of_every_other_kind_tiles_its_box) {
  const Pattern grid = grid_pattern(5);
  EXPECT_EQ(grid.cells.size(), 125u + 6);
  expect_tiling(grid);
  const Pattern bricks = brick_pattern(Vec3(0.6, 0.2, 0.3));
  expect_tiling(bricks);
  const Pattern slabs = slab_pattern(20, 0.3, 1);
  EXPECT_EQ(slabs.cells.size(), 20u + 6);
  expect_tiling(slabs);
  expect_tiling(web_pattern(1, 9, 0.3, 1));
}

TEST(Pattern, has_the_same_bits_on_every_machine) {
  std::uint64_t hash = 0;
  for (const Pattern& pattern :
       {voronoi_pattern(50, 2, false, 1), web_pattern(4, 9, 0.3, 1), slab_pattern(20, 0.3, 1)}) {
    for (const Plane& plane : pattern.planes) {
      for (const double x : plane.normal) hash = combine(hash, std::bit_cast<std::uint64_t>(x));
      hash = combine(hash, std::bit_cast<std::uint64_t>(plane.d));
    }
  }
  EXPECT_EQ(hash, 0x74b706089475b213ULL);
}

TEST(Pattern, of_bricks_has_a_bounded_number_of_cells) {
  EXPECT_LE(brick_pattern(Vec3(0.01, 0.02, 0.01)).cells.size(), kMostBricks + 100u);
  EXPECT_EQ(brick_pattern(Vec3(100, 1, 1)).cells.size(), 3u * (1 + 2 + 2) + 4);
}

TEST(Pattern, colors_join_cells) {
  PatternSpec spec;
  spec.kind = PatternSpec::Kind::kVoronoi;
  spec.cells = 60;
  spec.colors = 7;
  const Pattern pattern = make_pattern(spec, {}, 1);
  std::set<std::uint32_t> colors;
  for (const Cell& cell : pattern.cells) {
    if (!cell.outer) colors.insert(cell.color);
  }
  EXPECT_LE(colors.size(), 7u);
  EXPECT_GE(colors.size(), 5u);
}

TEST(Pattern, has_smaller_cells_towards_the_impact) {
  const Pattern pattern = voronoi_pattern(200, 2, false, 1);
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  for (const Cell& cell : pattern.cells) {
    if (cell.outer) continue;
    const double distance = mass_properties(cell.polyhedron).centroid.norm();
    if (distance < 0.4) near += cell.volume, ++near_count;
    if (distance > 0.6) far += cell.volume, ++far_count;
  }
  ASSERT_GT(near_count, 20);
  ASSERT_GT(far_count, 20);
  EXPECT_LT(near / near_count, 0.3 * far / far_count);
}

}  // namespace
}  // namespace sunder::fracture
