// Tests of ghosts: an overlap counts once, holds, and is cut (paper 4.3, figure 12).
#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/geometry/hull.h"
#include "fracture/adjacency/islands.h"
#include "fracture/adjacency/overlap.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/ring.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture::ghosts_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Part part(const Vec3& min, const Vec3& max, std::uint32_t material = 0) {
  return {make_box(min, max), MaterialIndex(material), 0};
}

/// Returns the exact volume of a union of boxes, summed over the grid that their sides make.
double union_volume(const std::vector<Box>& boxes) {
  std::array<std::set<double>, 3> sides;
  for (const Box& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      sides[axis].insert({box.min[axis], box.max[axis]});
    }
  }
  double sum = 0;
  for (auto x = sides[0].begin(); std::next(x) != sides[0].end(); ++x) {
    for (auto y = sides[1].begin(); std::next(y) != sides[1].end(); ++y) {
      for (auto z = sides[2].begin(); std::next(z) != sides[2].end(); ++z) {
        const Box cell{Vec3(*x, *y, *z), Vec3(*std::next(x), *std::next(y), *std::next(z))};
        const Vec3 center = cell.center();
        const bool inside = std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
          return (box.min.array() < center.array()).all() &&
                 (center.array() < box.max.array()).all();
        });
        if (inside) sum += cell.extent().prod();
      }
    }
  }
  return sum;
}

BreakCommand impact(const Vec3& at, double radius, int cells, std::uint64_t event = 1) {
  BreakCommand command;
  command.event = command.seed = event;
  command.pattern.kind = PatternSpec::Kind::kVoronoi;
  command.pattern.cells = cells;
  command.X_RP.position = at;
  command.radius_m = radius;
  return command;
}

TEST(Ghosts, of_a_column_under_a_roof_join_them_and_weigh_the_overlap_once) {
  const Compound hall = compound_of({{Vec3(0, 0, 0), Vec3(1, 3.2, 1)},
                                     {Vec3(4, 0, 0), Vec3(5, 3.2, 1)},
                                     {Vec3(-1, 3, -1), Vec3(6, 4, 2)}});
  ASSERT_EQ(hall.ghosts.size(), 2u);
  EXPECT_TRUE(hall.bonds.empty());
  EXPECT_EQ(hall.ghosts[0].of, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(hall.ghosts[1].of, (std::vector<std::uint32_t>{1, 2}));
  for (const Ghost& ghost : hall.ghosts) {
    EXPECT_EQ(ghost.sign, -1);
    EXPECT_NEAR(ghost.convex->solid.volume_m3, .2, 1e-12);
  }
  EXPECT_EQ(find_islands(hall), (std::vector<std::uint32_t>{0, 0, 0}));
  EXPECT_NEAR(volume(hall), 3 + 3 + 21, 1e-12);
  const std::vector<Material> materials(1);
  EXPECT_NEAR(mass_of(hall, materials).mass_kg, 27 * 2000, 1e-8);
  EXPECT_NEAR(mass_of(hall, materials).com_R.x(), 2.5, 1e-12);
}

TEST(Ghosts, faces_have_the_names_of_the_faces_they_lie_in) {
  const Compound pair =
      compound_of({{Vec3(0, 0, 0), Vec3(1, 2, 1)}, {Vec3(-1, 1, -1), Vec3(2, 3, 2)}});
  ASSERT_EQ(pair.ghosts.size(), 1u);
  for (const auto& face : pair.ghosts[0].convex->polyhedron.faces) {
    int owners = 0;
    for (const ConvexPtr& convex : pair.convexes) {
      for (const auto& own : convex->polyhedron.faces) owners += own.id == face.id;
    }
    EXPECT_EQ(owners, 1);
  }
}

TEST(Ghosts, do_not_arise_between_parts_that_only_touch) {
  EXPECT_TRUE(grid_compound(3, 3, 3).ghosts.empty());
  EXPECT_TRUE(voronoi_compound(60, 1).ghosts.empty());
  EXPECT_TRUE(ring_compound(12, .5, 1, .3).ghosts.empty());
  EXPECT_TRUE(make_solid("torus:1,.3").ghosts.empty());
}

TEST(Ghosts, of_three_mutual_overlaps_sum_to_the_volume_of_the_union) {
  const std::vector<Box> boxes{{Vec3(0, 0, 0), Vec3(2, 2, 2)},
                               {Vec3(1, 0, 0), Vec3(3, 2, 2)},
                               {Vec3(0.5, 1, 1), Vec3(2.5, 3, 3)}};
  const Compound trio = compound_of(boxes);
  ASSERT_EQ(trio.ghosts.size(), 4u);
  EXPECT_EQ(trio.ghosts[1].of, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(trio.ghosts[1].sign, 1);
  EXPECT_NEAR(volume(trio), union_volume(boxes), 1e-12);
}

TEST(Ghosts, of_one_convex_inside_another_subtract_all_of_it) {
  const Compound nut =
      compound_of({{Vec3(0, 0, 0), Vec3(2, 2, 2)}, {Vec3(.5, .5, .5), Vec3(1, 1, 1)}});
  ASSERT_EQ(nut.ghosts.size(), 1u);
  EXPECT_NEAR(volume(nut), 8, 1e-12);
  EXPECT_EQ(find_islands(nut), (std::vector<std::uint32_t>{0, 0}));
  const Compound twins =
      compound_of({{Vec3(0, 0, 0), Vec3(1, 1, 1)}, {Vec3(0, 0, 0), Vec3(1, 1, 1)}});
  EXPECT_NEAR(volume(twins), 1, 1e-12);
}

TEST(Ghosts, of_random_boxes_sum_to_the_volume_of_the_union) {
  Random random(21);
  for (int round = 0; round < 200; ++round) {
    const std::vector<Box> boxes = random_boxes(random, 2 + random.below(6));
    const double expected = union_volume(boxes);
    ASSERT_NEAR(volume(compound_of(boxes)), expected, 1e-12 * expected) << "round " << round;
  }
}

TEST(Ghosts, of_random_hulls_cover_every_point_of_the_union_once) {
  Random random(22);
  for (int round = 0; round < 20; ++round) {
    std::vector<Part> parts;
    for (int i = 0; i < 5; ++i) {
      std::vector<Vec3> points;
      const Vec3 center = .5 * random.direction();
      for (int k = 0; k < 12; ++k) points.push_back(center + random.direction());
      parts.push_back({make_hull(points), MaterialIndex(0u), 0});
    }
    const Compound cluster = make_compound(parts);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 point =
          1.5 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const bool inside = std::any_of(parts.begin(), parts.end(),
                                      [&](const Part& p) { return contains(p.polyhedron, point); });
      ASSERT_EQ(cover(cluster, point), inside ? 1 : 0);
    }
  }
}

TEST(Ghosts, are_bounded_for_many_parts_in_one_place) {
  Random random(23);
  const std::vector<Box> boxes = random_boxes(random, 40);
  const Compound heap = compound_of(boxes);
  const double expected = union_volume(boxes);
  EXPECT_NEAR(volume(heap), expected, 1e-4 * expected);  // Overlaps thinner than 1e-6 m are lost.
  for (const Ghost& ghost : heap.ghosts) EXPECT_LE(ghost.of.size(), kMaxConvexesPerGhost);
  EXPECT_LT(heap.ghosts.size(), 20000u);
  std::vector<Box> same(100, Box{Vec3(0, 0, 0), Vec3(1, 1, 1)});
  EXPECT_NEAR(volume(compound_of(same)), 1, 1e-12);
}

TEST(Ghosts, weigh_an_overlap_as_the_first_of_its_materials) {
  std::vector<Material> materials(2);
  materials[0].density_kg_m3 = 1000;
  materials[1].density_kg_m3 = 3000;
  const Part light = part(Vec3(0, 0, 0), Vec3(2, 1, 1), 0);
  const Part heavy = part(Vec3(1, 0, 0), Vec3(3, 1, 1), 1);
  EXPECT_NEAR(mass_of(make_compound({light, heavy}), materials).mass_kg, 2000 + 3000, 1e-9);
  EXPECT_NEAR(mass_of(make_compound({heavy, light}), materials).mass_kg, 1000 + 6000, 1e-9);
}

TEST(Ghosts, keep_the_invariants_when_a_column_breaks_under_its_roof) {
  const Compound hall = make_solid("hall:4");
  for (const double radius : {.6, 1.5, kInfinity}) {
    const BreakPlan plan = break_compound(hall, impact(Vec3(0, 2.6, 0), radius, 60));
    EXPECT_EQ(find_violation(hall, plan), "") << radius;
    EXPECT_GT(plan.pieces.size(), 3u) << radius;
    EXPECT_EQ(plan.failed, 0u);
  }
}

TEST(Ghosts, hold_a_column_to_the_roof_that_the_impact_does_not_reach) {
  const Compound pair =
      compound_of({{Vec3(0, 0, 0), Vec3(1, 4, 1)}, {Vec3(-1, 3.5, -1), Vec3(2, 5, 2)}});
  const BreakPlan plan = break_compound(pair, impact(Vec3(.5, 2.4, .5), 1, 40));
  EXPECT_EQ(find_violation(pair, plan), "");
  ASSERT_GT(plan.pieces.size(), 5u);
  const ConvexPtr& roof = pair.convexes[1];
  int kept = 0;
  for (const Compound& piece : plan.pieces) {
    const bool has_roof = std::count(piece.convexes.begin(), piece.convexes.end(), roof) > 0;
    EXPECT_EQ(piece.ghosts.empty(), !has_roof);
    for (const ConvexPtr& convex : piece.convexes) {
      const bool overlaps = !overlap(convex->polyhedron, roof->polyhedron, 1e-6).empty();
      EXPECT_EQ(overlaps && !has_roof, false);
      kept += overlaps && convex != roof;
    }
  }
  EXPECT_GT(kept, 0);
}

TEST(Ghosts, are_welded_away_where_a_cell_is_full) {
  const Compound pair =
      compound_of({{Vec3(-2, -2, -2), Vec3(1, 2, 2)}, {Vec3(-1, -2, -2), Vec3(2, 2, 2)}});
  const BreakPlan plan = break_compound(pair, impact(Vec3(.3, .1, 0), 1.2, 60));
  EXPECT_EQ(find_violation(pair, plan), "");
  EXPECT_GT(plan.welded, 20u);
  for (const Compound& piece : plan.pieces) {
    EXPECT_TRUE(piece.convexes.size() > 1 || piece.ghosts.empty());
  }
}

TEST(Ghosts, count_crack_area_once) {
  const Compound pair =
      compound_of({{Vec3(0, 0, 0), Vec3(2, 1, 1)}, {Vec3(1, 0, 0), Vec3(3, 1, 1)}});
  const Compound one = compound_of({{Vec3(0, 0, 0), Vec3(3, 1, 1)}});
  const BreakCommand command = impact(Vec3(1.4, .5, .5), kInfinity, 30);
  const BreakPlan of_pair = break_compound(pair, command), of_one = break_compound(one, command);
  ASSERT_EQ(of_pair.pieces.size(), of_one.pieces.size());
  EXPECT_NEAR(of_pair.new_area_m2, of_one.new_area_m2, 1e-9 * of_one.new_area_m2);
  double exposed = 0;
  for (const ExposedFace& face : of_pair.exposed) exposed += face.area_m2;
  EXPECT_NEAR(exposed, 2 * of_one.new_area_m2, 1e-9 * exposed);
}

TEST(Ghosts, are_the_same_for_any_number_of_threads) {
  std::set<std::uint64_t> hashes;
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    Random random(5);
    const Compound heap = compound_of(random_boxes(random, 12));
    const BreakPlan plan = break_compound(heap, impact(Vec3(.8, .8, .8), .5, 40));
    hashes.insert(combine(hash_of(heap), hash_of(plan)));
  }
  set_threads(0);
  EXPECT_EQ(hashes.size(), 1u);
}

}  // namespace
}  // namespace sunder::fracture::ghosts_test
