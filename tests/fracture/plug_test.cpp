// Tests of plugs that strikers drive out of solids, against closed forms and by volume, and of the
// number of cracks that an impact's energy makes.
#include "fracture/plug.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "fracture/pattern/cell_limit.h"
#include "fracture/pattern_breaker.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

Material brick() {
  Material material;
  material.density_kg_m3 = 1900;
  material.compressive_Pa = 8e6;
  material.shear_Pa = 6e5;
  material.youngs_Pa = 6e9;
  material.toughness_J_m2 = 60;
  material.pattern.kind = PatternSpec::Kind::kVoronoi;
  material.smallest_piece_m3 = 1e-4;
  material.smallest_break_m3 = 1e-3;
  return material;
}

/// Returns the impact of a ball of 0.4 m and 2.1 t in the middle of a wall of 0.4 m along z.
StructureImpact shot(double speed_m_s, double radius_m = 0.4, double thickness_m = 0.4) {
  StructureImpact hit;
  hit.point_R = Vec3(0.1, 0.2, 0);
  hit.direction_R = Vec3::UnitZ();
  hit.striker_kg = 2091;
  hit.speed_m_s = speed_m_s;
  hit.energy_J = 0.5 * hit.striker_kg * speed_m_s * speed_m_s;
  hit.thickness_m = thickness_m;
  hit.volume_m3 = 6 * 3 * thickness_m;
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.25 * std::numbers::pi * i;
    hit.section_R.push_back(hit.point_R + radius_m * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return hit;
}

/// Returns a shot from a random direction, up to 23 degrees off the normal.
StructureImpact tilted_shot(Random& random, double speed_m_s, double radius_m, double thickness_m) {
  StructureImpact hit = shot(speed_m_s, radius_m, thickness_m);
  const Vec3 tilt(random.uniform(-.3, .3), random.uniform(-.3, .3), 1);
  hit.direction_R = tilt.normalized();
  hit.thickness_m = thickness_m / hit.direction_R.z();
  return hit;
}

TEST(Plug, takes_the_perforation_energy_of_CEA_EDF_and_UKAEA) {
  Material material = brick();
  material.reinforcement_percent = 0.7;
  const auto limit_m_s = [&] {
    return std::sqrt(2 * perforation_energy_J(material, 0.8, 0.4, 2091) / 2091);
  };
  EXPECT_NEAR(limit_m_s(), 20.0, 0.2);
  material.reinforcement_percent = 0;
  EXPECT_NEAR(limit_m_s(), 20.0 * std::sqrt(0.3), 0.2);
}

TEST(Plug, takes_more_energy_along_a_slanted_path_by_what_is_sheared) {
  Pose X_RP;
  const auto straight = make_plug(brick(), shot(60), X_RP);
  StructureImpact hit = shot(60);
  hit.cosine = 0.6;
  hit.path_m = 0.4 / hit.cosine;
  hit.thickness_m = hit.path_m + 0.3;
  const auto slanted = make_plug(brick(), hit, X_RP);
  ASSERT_TRUE(straight && slanted);
  EXPECT_NEAR(slanted->energy_J, straight->energy_J / hit.cosine, 1e-9 * straight->energy_J);
  EXPECT_NEAR(slanted->mass_kg, straight->mass_kg / hit.cosine, 1e-9 * straight->mass_kg);
  EXPECT_EQ(slanted->depth_m, hit.thickness_m);
}

TEST(Plug, is_not_sheared_out_of_plates_outside_of_the_range_of_the_formula) {
  EXPECT_EQ(perforation_energy_J(brick(), 0.8, 0.19, 2091), 0);
  EXPECT_GT(perforation_energy_J(brick(), 0.8, 0.20, 2091), 0);
}

TEST(Plug, goes_through_above_the_limit_and_as_deep_as_the_energy_lasts_below) {
  Pose X_RP;
  const double limit_J = perforation_energy_J(
      brick(), 2 * std::sqrt(4 * std::sin(0.25 * std::numbers::pi) / std::numbers::pi) * 0.4, 0.4,
      2091);
  const double limit_m_s = std::sqrt(2 * limit_J / 2091);
  const auto above = make_plug(brick(), shot(1.01 * limit_m_s), X_RP);
  ASSERT_TRUE(above);
  EXPECT_TRUE(above->through);
  EXPECT_NEAR(above->energy_J, limit_J, 1e-6 * limit_J);
  const StructureImpact weak = shot(0.5 * limit_m_s);
  const auto below = make_plug(brick(), weak, X_RP);
  ASSERT_TRUE(below);
  EXPECT_FALSE(below->through);
  EXPECT_LE(below->energy_J, weak.energy_J);
  EXPECT_NEAR(below->depth_m, 0.4 * std::pow(0.25, 0.375), 1e-3);
}

TEST(Plug, needs_a_solid_that_extends_around_it) {
  Pose X_RP;
  StructureImpact hit = shot(40);
  hit.confined = false;
  EXPECT_FALSE(make_plug(brick(), hit, X_RP));
  hit = shot(40);
  hit.volume_m3 = 0.5;
  EXPECT_FALSE(make_plug(brick(), hit, X_RP));
}

TEST(Plug, leaves_no_crater_that_is_smaller_than_the_smallest_break) {
  Pose X_RP;
  const auto dent = make_plug(brick(), shot(0.1), X_RP);
  ASSERT_TRUE(dent);
  EXPECT_TRUE(dent->section_m.empty());
}

TEST(Plug, leaves_a_hole_and_keeps_the_volume) {
  const std::vector<Material> materials{brick()};
  const auto breaker = make_pattern_breaker();
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed, 77);
    const double thickness_m = random.uniform(0.1, 0.6), radius_m = random.uniform(0.1, 0.5);
    const Compound wall = box_compound(Vec3(-3, -1.5, 0), Vec3(3, 1.5, thickness_m));
    const double speed_m_s = random.uniform(5, 100);
    const StructureImpact hit = tilted_shot(random, speed_m_s, radius_m, thickness_m);
    const BreakCommand command = breaker->command(*wall.convexes[0], materials, hit, seed, seed);
    ASSERT_TRUE(command.plug);
    const BreakPlan plan = break_compound(wall, command);
    EXPECT_EQ(plan.failed, 0u);
    EXPECT_NEAR(total_volume(plan), volume(wall), 1e-9 * volume(wall)) << seed;
    if (!plan.broke()) continue;
    const Vec3 deep = 0.5 * std::min(command.plug->depth_m, thickness_m) * Vec3::UnitY();
    EXPECT_EQ(cover(plan.pieces[0], command.X_RP * deep), 0) << seed;
    EXPECT_EQ(cover(plan.pieces[0], Vec3(2.9, 1.4, 0.5 * thickness_m)), 1) << seed;
  }
}

TEST(Plug, has_the_section_of_the_striker_and_a_crushed_ring_around_it) {
  const std::vector<Material> materials{brick()};
  const auto breaker = make_pattern_breaker();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed, 78);
    const double thickness_m = random.uniform(0.1, 0.3), radius_m = random.uniform(0.2, 0.5);
    const Compound wall = box_compound(Vec3(-3, -1.5, 0), Vec3(3, 1.5, thickness_m));
    const StructureImpact hit = tilted_shot(random, 100, radius_m, thickness_m);
    const BreakCommand command = breaker->command(*wall.convexes[0], materials, hit, seed, seed);
    ASSERT_TRUE(command.plug && command.plug->through);
    const BreakEdit edit = breaker->plan(Structure(wall), command);
    ASSERT_EQ(edit.loose.crushed.size(), edit.loose.pieces.size());
    const Pose X_PR = command.X_RP.inverse();
    double plug_m3 = 0, crushed_m3 = 0;
    for (std::size_t i = 0; i < edit.loose.pieces.size(); ++i) {
      const Compound& piece = edit.loose.pieces[i];
      if (edit.loose.crushed[i]) crushed_m3 += volume(piece);
      if (command.plug->contains(X_PR * piece.convexes[0]->solid.centroid))
        plug_m3 += volume(piece);
    }
    const double clearance = command.plug->clearance;
    EXPECT_NEAR(plug_m3, command.plug->mass_kg / brick().density_kg_m3, 0.01 * plug_m3) << seed;
    EXPECT_NEAR(crushed_m3 / plug_m3, clearance * clearance - 1, 0.01) << seed;
  }
}

TEST(Plug, without_a_pattern_takes_the_convexes_in_its_path) {
  Material chunks = brick();
  chunks.pattern.kind = PatternSpec::Kind::kNone;
  const std::vector<Material> materials{chunks};
  const Compound wall = make_solid("grid:9,9,1");
  StructureImpact hit = shot(40, 1.4, 1);
  hit.point_R = Vec3(4.5, 4.5, 0);
  hit.volume_m3 = 81;
  for (Vec3& corner : hit.section_R) corner += hit.point_R - Vec3(0.1, 0.2, 0);
  const auto breaker = make_pattern_breaker();
  const BreakCommand command = breaker->command(*wall.convexes[0], materials, hit, 1, 1);
  ASSERT_TRUE(command.plug);
  const Structure structure(wall);
  const BreakEdit edit = breaker->plan(structure, command);
  ASSERT_TRUE(edit.changed);
  EXPECT_GE(edit.loose.pieces.size(), 9u);
  EXPECT_LE(edit.loose.pieces.size(), 21u);
  for (const Compound& piece : edit.loose.pieces) EXPECT_EQ(piece.convexes.size(), 1u);
}

TEST(Plug, without_a_pattern_lets_the_striker_through_near_an_edge) {
  Material chunks = brick();
  const Compound wall = make_solid("grid:9,9,1");
  StructureImpact hit = shot(120, 0.7, 1);
  const Vec3 corner(0.6, 0.6, 0);
  for (Vec3& one : hit.section_R) one += corner - hit.point_R;
  hit.point_R = corner;
  hit.volume_m3 = 81;
  hit.confined = false;
  const auto breaker = make_pattern_breaker();
  for (const bool has_pattern : {true, false}) {
    if (!has_pattern) chunks.pattern.kind = PatternSpec::Kind::kNone;
    const std::vector<Material> materials{chunks};
    const BreakCommand command = breaker->command(*wall.convexes[0], materials, hit, 1, 1);
    ASSERT_EQ(command.plug.has_value(), !has_pattern);
    if (has_pattern) continue;
    EXPECT_TRUE(command.plug->through);
    const BreakEdit edit = breaker->plan(Structure(wall), command);
    ASSERT_TRUE(edit.changed);
    for (const Compound& piece : edit.loose.pieces) {
      ASSERT_EQ(piece.convexes.size(), 1u);
      EXPECT_LT((piece.convexes[0]->solid.centroid - corner).cwiseAbs().maxCoeff(), 2);
    }
  }
}

TEST(Plug, has_rings_of_cracks_around_it_that_are_no_regular_polygons) {
  constexpr std::size_t kCorners = 8, kRings = 5, kSeeds = 8;
  Plug plug;
  plug.rings = kRings;
  plug.reach_m = 1;
  plug.depth_m = 0.02;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const double angle = 0.25 * std::numbers::pi * static_cast<double>(i);
    plug.section_m.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle));
  }
  double spread = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Pattern pattern = plug_pattern(plug, 1, seed);
    double farthest_inside = 0;
    for (std::size_t ring = 0; ring <= kRings; ++ring) {
      double least = std::numeric_limits<double>::infinity(), most = 0;
      for (std::size_t chord = 0; chord < kCorners; ++chord) {
        const std::size_t plane = Pattern::kBoxPlanes + kCorners * (1 + ring) + chord;
        const double distance = std::abs(pattern.planes[plane].distance(Vec3::Zero()));
        least = std::min(least, distance);
        most = std::max(most, distance);
      }
      EXPECT_GT(least, 0);
      if (ring > 0) spread += (most - least) / (most - farthest_inside) / (kRings * kSeeds);
      farthest_inside = most;
    }
  }
  EXPECT_GT(spread, 0.4);
}

TEST(Detail, costs_at_most_a_tenth_of_the_energy) {
  const Material material = brick();
  StructureImpact hit;
  hit.reached_m3 = 1;
  const double radius_m = 1;
  int before = 0;
  for (const double energy_J : {1e1, 1e3, 3e3, 1e4, 3e4, 1e5, 1e7}) {
    hit.energy_J = energy_J;
    PatternSpec pattern;
    pattern.kind = PatternSpec::Kind::kVoronoi;
    pattern.cells = 512;
    limit_cells_by_energy(material, hit, radius_m, 0, pattern);
    EXPECT_GE(pattern.cells, before);
    before = pattern.cells;
    const double sphere_m3 = 4.0 / 3 * std::numbers::pi;
    const auto cost_J = [&](int cells) {
      return 2.91 * std::cbrt(cells / sphere_m3) * material.toughness_J_m2;
    };
    if (pattern.cells > 2) {
      EXPECT_LE(cost_J(pattern.cells), 0.1 * energy_J);
    }
    if (pattern.cells < 512) {
      EXPECT_GT(cost_J(2 * pattern.cells), 0.1 * energy_J);
    }
  }
  EXPECT_EQ(before, 512);
}

TEST(Detail, of_a_web_in_a_cube_costs_at_most_a_tenth_of_the_energy) {
  const Material material = brick();
  StructureImpact hit;
  hit.reached_m3 = 1;
  const int rings = 6, spokes = 12;
  // A cylinder as deep as the cube: its radius is 1/√π m.
  const double crack_m2 = (spokes + std::numbers::pi * rings) / std::sqrt(std::numbers::pi);
  for (const double share : {0.99, 1.01}) {
    PatternSpec web;
    web.kind = PatternSpec::Kind::kWeb;
    web.rings = rings, web.spokes = spokes;
    hit.energy_J = share * crack_m2 * material.toughness_J_m2 / 0.1;
    limit_cells_by_energy(material, hit, std::numeric_limits<double>::infinity(), 0, web);
    EXPECT_EQ(web.rings, share > 1 ? rings : rings / 2);
    EXPECT_EQ(web.spokes, share > 1 ? spokes : spokes / 2);
  }
}

TEST(Detail, of_a_web_goes_down_to_three_spokes_and_a_ring) {
  StructureImpact hit;
  hit.reached_m3 = 0.006;
  hit.energy_J = 1e-3;
  PatternSpec pattern;
  pattern.kind = PatternSpec::Kind::kWeb;
  pattern.rings = 7, pattern.spokes = 14;
  limit_cells_by_energy(brick(), hit, 0.7, 0.006, pattern);
  EXPECT_EQ(pattern.rings, 1);
  EXPECT_EQ(pattern.spokes, 3);
  PatternSpec bricks;
  bricks.kind = PatternSpec::Kind::kBrick;
  limit_cells_by_energy(brick(), hit, 0.7, 0.006, bricks);
  EXPECT_EQ(bricks.cells, PatternSpec().cells);  // Bricks have a size and not a number of cells.
}

}  // namespace
}  // namespace sunder::fracture
