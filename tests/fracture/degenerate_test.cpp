// Tests of degenerate cuts, of sizes from a nanometre to a thousand kilometres, and of independence
// from order, threads and other breaks at once.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/fracture.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

BreakPlan cut(const Compound& solid, const Pattern& pattern, const Placement& placement) {
  return fracture(solid, pattern, placement, {placement.origin_R, kInfinity}, 1);
}

BreakCommand impact(PatternSpec::Kind kind, int cells, const Vec3& at, double radius) {
  BreakCommand command;
  command.pattern.kind = kind;
  command.pattern.cells = cells;
  command.X_RP.position = at;
  command.radius_m = radius;
  return command;
}

TEST(DegenerateCuts, through_vertices_and_along_faces_keep_every_invariant) {
  // Cells of side 1 on a grid of boxes of side 1: planes lie in the boxes' faces, or half way.
  const Compound solid = grid_compound(4, 4, 4);
  const Pattern cubes = grid_pattern(4);
  for (const double shift : {0., .5, 1e-15, -1e-15, 1e-12, 1e-9, 1. / 3}) {
    for (const double size : {1., 2., 3., .5}) {
      const Placement placement{size * Mat3::Identity(), Vec3(2, 2 + shift, 2 - shift)};
      const BreakPlan plan = cut(solid, cubes, placement);
      EXPECT_EQ(find_violation(solid, plan), "") << shift << " " << size;
      EXPECT_EQ(plan.failed, 0u);
    }
  }
}

TEST(DegenerateCuts, along_diagonals_keep_every_invariant) {
  const Compound solid = grid_compound(3, 3, 3);
  const Mat3 rotation =
      Quat(std::cos(std::numbers::pi / 8), 0, 0, std::sin(std::numbers::pi / 8)).toRotationMatrix();
  const Pattern cubes = grid_pattern(4);
  for (const double size : {std::numbers::sqrt2, std::numbers::sqrt2 / 2, 2.}) {
    const BreakPlan plan = cut(solid, cubes, {size * rotation, Vec3::Constant(1.5)});
    EXPECT_EQ(find_violation(solid, plan), "") << size;
    EXPECT_GT(plan.pieces.size(), 8u);
  }
}

TEST(DegenerateCuts, by_cells_without_thickness_keep_every_invariant) {
  const Compound solid = box_compound(Vec3::Constant(-1), Vec3::Constant(1));
  for (const double thin : {1e-6, 1e-9, 1e-12, 1e-15}) {
    std::vector<Vec3> sites{Vec3::Zero(), Vec3(0, thin, 0), Vec3(0, 2 * thin, 0), Vec3(.5, .1, 0)};
    const BreakPlan plan = cut(solid, voronoi_pattern(sites), {});
    EXPECT_EQ(find_violation(solid, plan), "") << thin;
    EXPECT_EQ(plan.failed, 0u) << thin;
    EXPECT_GE(plan.pieces.size(), 2u) << thin;
  }
}

TEST(DegenerateCuts, of_solids_of_any_size_keep_every_invariant) {
  for (const double size : {1e-9, 1e-6, 1e-3, 1., 1e3, 1e6}) {
    for (const auto kind : {PatternSpec::Kind::kVoronoi, PatternSpec::Kind::kGrid}) {
      const int cells = kind == PatternSpec::Kind::kGrid ? 3 : 30;
      std::vector<Part> parts;
      for (const double x : {0., 1., 1.75}) {  // The last two boxes overlap.
        parts.push_back(
            {make_box(size * Vec3(x, 0, 0), size * Vec3(x + 1, 1, 1)), MaterialIndex(0u), 0});
      }
      const Compound solid = make_compound(parts, 1e-6 * size);
      EXPECT_EQ(solid.ghosts.size(), 1u) << size;
      const BreakPlan plan =
          break_compound(solid, impact(kind, cells, size * Vec3(1, .5, .5), kInfinity));
      EXPECT_EQ(find_violation(solid, plan), "") << size;
      EXPECT_GT(plan.pieces.size(), cells == 3 ? 2u : 15u) << size;
      EXPECT_EQ(plan.failed, 0u);
    }
  }
}

TEST(Fracture, is_the_same_to_the_bit_for_any_order_of_convexes) {
  Random random(17);
  for (const char* name : {"voronoi:60", "hall:3"}) {
    const Compound solid = make_solid(name);
    const BreakCommand command =
        impact(PatternSpec::Kind::kVoronoi, 40, Vec3(.1, 2.8, .05).cwiseMin(bounds(solid).max), .9);
    const std::uint64_t expected = hash_any_order(break_compound(solid, command));
    for (int round = 0; round < 5; ++round) {
      std::vector<std::uint32_t> order(solid.convexes.size());
      std::iota(order.begin(), order.end(), 0u);
      for (std::size_t i = order.size() - 1; i > 0; --i) {
        std::swap(order[i], order[random.below(static_cast<std::uint32_t>(i + 1))]);
      }
      EXPECT_EQ(hash_any_order(break_compound(reordered(solid, order), command)), expected) << name;
    }
  }
}

TEST(Fracture, of_different_compounds_at_once_gives_the_same_bits) {
  std::vector<Compound> solids;
  for (int i = 0; i < 12; ++i) solids.push_back(voronoi_compound(10 + i, i + 1));
  const auto plan = [&](std::size_t i) {
    return hash_of(
        break_compound(solids[i], impact(PatternSpec::Kind::kVoronoi, 20, Vec3(.1, 0, .1), .3)));
  };
  std::vector<std::uint64_t> alone(solids.size()), together(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) alone[i] = plan(i);
  set_threads(4);
  for_chunks(solids.size(), 1,
             [&](std::size_t i, std::size_t, std::size_t) { together[i] = plan(i); });
  set_threads(0);
  EXPECT_EQ(alone, together);
}

TEST(Fracture, leaves_contacts_that_agree_with_the_papers_sort_by_distance) {
  for (const auto& [name, at] :
       {std::pair("grid:3,3,3", Vec3(1.5, 1.5, 1.5)), std::pair("voronoi:40", Vec3(0, 0, 0)),
        std::pair("hall:2", Vec3(0, 3.1, 0))}) {
    const Compound solid = make_solid(name);
    const BreakPlan plan = break_compound(solid, impact(PatternSpec::Kind::kVoronoi, 25, at, .8));
    std::size_t bonds = 0;
    for (const Compound& piece : plan.pieces) {
      const std::vector<Bond> expected = contacts_by_distance(piece, 1e-9);
      ASSERT_EQ(piece.bonds.size(), expected.size()) << name;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(piece.bonds[i].a, expected[i].a);
        EXPECT_EQ(piece.bonds[i].b, expected[i].b);
        EXPECT_NEAR(piece.bonds[i].area_m2, expected[i].area_m2, 1e-9);
      }
      bonds += expected.size();
    }
    EXPECT_GT(bonds, 20u) << name;
  }
}

TEST(Fracture, covers_space_as_its_parent_by_winding_numbers) {
  Random random(8);
  for (const char* name : {"torus:1,.3", "hall:2"}) {
    const Compound solid = make_solid(name);
    const Box box = bounds(solid);
    BreakCommand command = impact(PatternSpec::Kind::kVoronoi, 40, box.center(), kInfinity);
    command.stretch_P = Vec3(1, .5, 2).asDiagonal();
    const BreakPlan plan = break_compound(solid, command);
    ASSERT_GT(plan.pieces.size(), 10u);
    for (int i = 0; i < 300; ++i) {
      const Vec3 place(random.uniform(), random.uniform(), random.uniform());
      const Vec3 point = box.min + place.cwiseProduct(box.extent());
      double after = 0;
      for (const Compound& piece : plan.pieces) after += winding(piece, point);
      EXPECT_NEAR(after, winding(solid, point), 1e-6);
    }
  }
}

TEST(Fracture, keeps_volume_after_export_to_single_precision) {
  for (const char* name : {"box:1,2,3", "torus:1,.3", "voronoi:30"}) {
    const Compound solid = make_solid(name);
    const BreakPlan plan =
        break_compound(solid, impact(PatternSpec::Kind::kVoronoi, 60, Vec3(.1, .2, .1), kInfinity));
    double exported = 0;
    for (const Compound& piece : plan.pieces) {
      for (const ConvexPtr& convex : piece.convexes) {
        ConvexPolyhedron rounded = convex->polyhedron;
        for (Vec3& vertex : rounded.vertices) vertex = vertex.cast<float>().cast<double>();
        exported += mass_properties(rounded).volume_m3;
      }
    }
    EXPECT_NEAR(exported, volume(solid), 1e-5 * volume(solid)) << name;
  }
}

TEST(Fracture, of_coloured_cells_makes_one_piece_per_colour) {
  const Compound solid = box_compound(Vec3::Constant(-1), Vec3::Constant(1));
  BreakCommand command = impact(PatternSpec::Kind::kGrid, 4, Vec3::Zero(), 1);
  command.pattern.colors = 5;
  const BreakPlan plan = break_compound(solid, command);
  EXPECT_EQ(find_violation(solid, plan), "");
  EXPECT_EQ(plan.pieces.size(), 5u);
  const auto is_large = [](const Compound& piece) { return piece.convexes.size() > 1; };
  EXPECT_GT(std::count_if(plan.pieces.begin(), plan.pieces.end(), is_large), 2);
}

TEST(Fracture, by_a_deformed_pattern_welds_cells_scaled_by_its_determinant) {
  const Pattern cubes = grid_pattern(4);
  const Compound solid = grid_compound(9, 9, 9, Vec3::Constant(1. / 3));
  Mat3 linear;
  linear << .8, .3, 0, -.1, .7, .2, 0, .1, .9;
  const BreakPlan plan = cut(solid, cubes, {linear, Vec3::Constant(1.5)});
  EXPECT_EQ(find_violation(solid, plan), "");
  EXPECT_GT(plan.welded, 20u);
  int cells = 0;
  for (const Compound& piece : plan.pieces) {
    cells += std::abs(volume(piece) - linear.determinant() / 8) < 1e-12;
  }
  EXPECT_GT(cells, 20);
}

}  // namespace
}  // namespace sunder::fracture
