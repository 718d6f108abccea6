// Tests of whole breaks: invariants, unchanged convexes, unbreakable materials, exposed faces.
#include "fracture/fracture.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/islands.h"
#include "fracture/pattern_breaker.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/ring.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PatternSpec voronoi(int cells) {
  PatternSpec spec;
  spec.kind = PatternSpec::Kind::kVoronoi;
  spec.cells = cells;
  return spec;
}

PatternSpec web(int rings, int spokes) {
  PatternSpec spec;
  spec.kind = PatternSpec::Kind::kWeb;
  spec.rings = rings;
  spec.spokes = spokes;
  return spec;
}

PatternSpec eighths() {
  PatternSpec spec;
  spec.kind = PatternSpec::Kind::kGrid;
  spec.cells = 2;
  return spec;
}

BreakCommand impact(const PatternSpec& pattern, const Vec3& at, double radius,
                    std::uint64_t event = 1) {
  BreakCommand command;
  command.event = event;
  command.seed = event;
  command.pattern = pattern;
  command.X_RP.position = at;
  command.radius_m = radius;
  return command;
}

TEST(Fracture, keeps_every_invariant_when_a_whole_box_breaks) {
  const Compound box = box_compound(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const BreakPlan plan = break_compound(box, impact(voronoi(50), Vec3(0.2, 0.1, 0.3), kInfinity));
  EXPECT_EQ(find_violation(box, plan), "");

  EXPECT_GT(plan.pieces.size(), 35u);
  EXPECT_EQ(plan.failed, 0u);
  EXPECT_EQ(plan.debris_volume_m3, 0);
}

TEST(Fracture, breaks_every_solid_that_is_built_in) {
  for (const char* name : {"box:1,2,3", "column:.5,2", "torus:1,.3", "grid:3,2,1", "voronoi:9"}) {
    const Compound solid = make_solid(name);
    EXPECT_EQ(find_islands(solid.convexes.size(), solid.bonds).back(), 0u) << name;
    const BreakPlan plan = break_compound(solid, impact(voronoi(30), Vec3(.7, .2, .1), kInfinity));
    EXPECT_EQ(find_violation(solid, plan), "") << name;
    EXPECT_GT(plan.pieces.size(), 5u) << name;
  }
  for (const char* name :
       {"", "box", "box:1,2", "box:1,2,-3", "torus:1,2", "grid:1.5,1,1", "voronoi:x", "ball:1",
        "voronoi:2e9", "grid:1000,1000,2", "grid:2,1000,1000"}) {
    EXPECT_THROW(make_solid(name), InputError) << name;
  }
}

TEST(Fracture, covers_every_point_exactly_once) {
  const Compound ring = ring_compound(12, 0.6, 1, 0.5);
  const BreakPlan plan = break_compound(ring, impact(voronoi(40), Vec3(0.8, 0.2, 0), 0.7));
  ASSERT_TRUE(plan.broke());
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 point(random.uniform(-1.1, 1.1), random.uniform(-.1, .6), random.uniform(-1.1, 1.1));
    int inside = 0;
    for (const ConvexPtr& convex : ring.convexes) inside += contains(convex->polyhedron, point);
    ASSERT_EQ(cover(plan, point), inside);
  }
}

TEST(Fracture, that_misses_returns_its_input) {
  const Compound wall = grid_compound(4, 4, 1);
  const BreakPlan plan = break_compound(wall, impact(voronoi(50), Vec3(20, 0, 0), 1));
  ASSERT_EQ(plan.pieces.size(), 1u);
  EXPECT_EQ(plan.pieces[0].convexes, wall.convexes);
  EXPECT_EQ(hash_of(plan.pieces[0]), hash_of(wall));
  EXPECT_EQ(plan.untouched, wall.convexes.size());
}

TEST(Fracture, keeps_convexes_outside_the_sphere_as_the_same_objects) {
  const Compound wall = grid_compound(10, 10, 2, Vec3(0.4, 0.2, 0.2), true);
  const Vec3 at(2.1, 1.1, 0.4);
  const BreakPlan plan = break_compound(wall, impact(voronoi(50), at, 0.5));
  ASSERT_TRUE(plan.broke());
  EXPECT_EQ(find_violation(wall, plan), "");
  const ImpactSphere sphere{at, 0.5};
  std::set<const Convex*> kept;
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) kept.insert(convex.get());
  }
  for (const ConvexPtr& convex : wall.convexes) {
    EXPECT_TRUE(kept.count(convex.get()) || sphere.touches(*convex));
  }
  EXPECT_TRUE(plan.pieces[0].is_anchored());
}

TEST(Fracture, joins_the_parts_outside_the_sphere_into_one_piece) {
  const Compound pane = box_compound(Vec3(-1, -1, -.003), Vec3(1, 1, .003));
  BreakCommand command = impact(web(6, 12), Vec3(0.2, 0.1, 0), 0.4);
  command.X_RP.rotation = Quat(Mat3((Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished()));
  const BreakPlan plan = break_compound(pane, command);
  EXPECT_EQ(find_violation(pane, plan), "");
  ASSERT_GT(plan.pieces.size(), 50u);
  double largest = 0;
  for (const Compound& piece : plan.pieces) {
    const Box box = bounds(piece);
    if (volume(piece) > largest) largest = volume(piece);
    if (volume(piece) < 0.5 * volume(pane)) {
      const Vec3 farthest = (box.max - command.X_RP.position)
                                .cwiseAbs()
                                .cwiseMax((box.min - command.X_RP.position).cwiseAbs());
      EXPECT_LT(farthest.x(), 0.5);
      EXPECT_LT(farthest.y(), 0.5);
    }
  }
  EXPECT_GT(largest, 0.8 * volume(pane));
}

TEST(Fracture, aligns_a_web_with_its_pane_at_the_impact) {
  const auto breaker = make_pattern_breaker();
  const Compound pane = box_compound(Vec3(-1, -1, -.003), Vec3(1, 1, .003));
  Material glass;
  glass.pattern = web(6, 12);
  glass.impact_radius_m = 0.4;
  const StructureImpact hit{Vec3(0.3, -0.2, 0.003), Vec3(0.6, 0, -0.8), ConvexSlot(0), 1};
  const BreakCommand command =
      breaker->command(*pane.convexes[0], std::span(&glass, 1), hit, 1, 42);
  const Vec3 axis = command.X_RP.rotation * Vec3::UnitY();
  EXPECT_NEAR(std::abs(axis.z()), 1, 1e-12);
  const BreakPlan plan = break_compound(pane, command);
  ASSERT_GT(plan.pieces.size(), 50u);
  int at_the_impact = 0;  // The innermost pieces meet at the impact.
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) {
      for (const Vec3& vertex : convex->polyhedron.vertices) {
        if ((vertex - hit.point_R).norm() < 1e-9) ++at_the_impact;
      }
    }
  }
  EXPECT_EQ(at_the_impact, 12);
}

TEST(Fracture, uses_the_pattern_of_the_impacts_strength) {
  const auto breaker = make_pattern_breaker();
  const Compound box = box_compound(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  Material stone;
  stone.pattern = voronoi(10);
  stone.impact_radius_m = 0.5;
  stone.stronger = {{100, voronoi(20), 0.7}, {1000, web(3, 6), 0.9}};
  const auto radius = [&](double energy_J) {
    const StructureImpact hit{Vec3(0, 1, 0), Vec3(0, -1, 0), ConvexSlot(0), energy_J};
    return breaker->command(*box.convexes[0], std::span(&stone, 1), hit, 1, 1);
  };
  EXPECT_EQ(radius(99).radius_m, 0.5);
  EXPECT_EQ(radius(100).radius_m, 0.7);
  EXPECT_EQ(radius(100).pattern.cells, 20);
  EXPECT_EQ(radius(5000).radius_m, 0.9);
  EXPECT_EQ(radius(5000).pattern.kind, PatternSpec::Kind::kWeb);
}

TEST(Fracture, lists_the_unbreakable_materials_in_its_command) {
  const Compound box = box_compound(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  std::vector<Material> materials(4);
  materials[0].pattern = voronoi(10);
  materials[2].pattern = voronoi(10);
  const BreakCommand command =
      make_pattern_breaker()->command(*box.convexes[0], materials, StructureImpact{}, 1, 1);
  EXPECT_EQ(command.unbreakable, (std::vector{MaterialIndex(1u), MaterialIndex(3u)}));
}

/// Returns convexes in a row, each a metre wide, of the given materials.
Compound row_of(std::initializer_list<std::uint32_t> materials) {
  std::vector<Part> parts;
  for (const std::uint32_t material : materials) {
    const auto x = static_cast<double>(parts.size());
    parts.push_back({make_box(Vec3(x, 0, 0), Vec3(x + 1, 1, 1)), MaterialIndex(material)});
  }
  return make_compound(std::move(parts));
}

TEST(Fracture, separates_breakable_from_unbreakable_convexes_at_their_bond) {
  const Compound row = row_of({0, 1});
  BreakCommand command = impact(eighths(), Vec3(.5, .5, .5), 0.6);
  command.unbreakable = {MaterialIndex(1u)};
  const BreakPlan plan = break_compound(row, command);
  EXPECT_EQ(find_violation(row, plan), "");
  ASSERT_EQ(plan.pieces.size(), 9u);
  EXPECT_EQ(plan.pieces[0].convexes, std::vector{row.convexes[1]});
  EXPECT_NEAR(plan.new_area_m2, 3 + 1, 1e-12);
  double exposed = 0;
  for (const ExposedFace& face : plan.exposed) {
    EXPECT_EQ(face.material, MaterialIndex(0u)) << "the bond has the weaker side's strength";
    exposed += face.area_m2;
  }
  EXPECT_NEAR(exposed, 2 * plan.new_area_m2, 1e-12);
}

TEST(Fracture, attributes_an_unbreakable_face_to_each_material_that_broke_off_it) {
  Compound bar = make_compound({{make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), MaterialIndex(0u)},
                                {make_box(Vec3(1, 0, 0), Vec3(3, 1, 1)), MaterialIndex(2u)},
                                {make_box(Vec3(0, -1, 0), Vec3(3, 0, 1)), MaterialIndex(1u)}});
  BreakCommand command = impact(voronoi(9), Vec3(1, .5, .5), kInfinity);
  command.unbreakable = {MaterialIndex(1u)};
  const BreakPlan plan = break_compound(bar, command);
  double area[3] = {};
  for (const ExposedFace& face : plan.exposed) {
    const Convex& convex = *plan.pieces[face.piece].convexes[face.convex];
    if (convex.material == MaterialIndex(1u)) area[face.material.value] += face.area_m2;
  }
  EXPECT_NEAR(area[0], 1, 1e-12);
  EXPECT_EQ(area[1], 0);
  EXPECT_NEAR(area[2], 2, 1e-12);
}

TEST(Fracture, keeps_unbreakable_and_unreached_convexes_together) {
  const Compound row = row_of({1, 1, 0, 1, 0, 0});
  BreakCommand command = impact(eighths(), Vec3(2.5, .5, .5), 0.9);
  command.unbreakable = {MaterialIndex(1u)};
  const BreakPlan plan = break_compound(row, command);
  EXPECT_EQ(find_violation(row, plan), "");
  std::vector<std::vector<ConvexPtr>> whole;
  for (const Compound& piece : plan.pieces) {
    if (piece.convexes[0]->material == MaterialIndex(1u) || piece.convexes.size() > 1)
      whole.push_back(piece.convexes);
  }
  const auto& before = row.convexes;
  EXPECT_EQ(whole, (std::vector<std::vector<ConvexPtr>>{{before[3], before[4], before[5]},
                                                        {before[0], before[1]}}));
}

TEST(Fracture, does_not_depend_on_the_order_of_convexes) {
  const Compound wall = grid_compound(5, 4, 2, Vec3(0.4, 0.2, 0.2), true);
  Compound reversed = wall;
  const auto last = static_cast<std::uint32_t>(wall.convexes.size() - 1);
  std::reverse(reversed.convexes.begin(), reversed.convexes.end());
  std::reverse(reversed.anchored.begin(), reversed.anchored.end());
  for (Bond& bond : reversed.bonds) {
    bond = {last - bond.b, last - bond.a, bond.face_b, bond.face_a, bond.area_m2};
  }
  sort_bonds(reversed.bonds);
  const auto pieces = [&](const Compound& solid) {
    // Smallest volume of a convex, and number of bonds, of each piece.
    std::multiset<std::pair<double, std::size_t>> found;
    for (const Compound& piece :
         break_compound(solid, impact(voronoi(40), Vec3(1, .4, .2), 0.5)).pieces) {
      double least = std::numeric_limits<double>::infinity();
      for (const ConvexPtr& convex : piece.convexes) {
        least = std::min(least, convex->solid.volume_m3);
      }
      found.emplace(least, piece.bonds.size());
    }
    return found;
  };
  EXPECT_EQ(pieces(wall), pieces(reversed));
}

TEST(Fracture, is_the_same_for_any_number_of_threads) {
  const Compound wall = grid_compound(8, 8, 2, Vec3(0.4, 0.2, 0.2), true);
  std::set<std::uint64_t> hashes;
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    hashes.insert(hash_of(break_compound(wall, impact(voronoi(60), Vec3(1.5, .8, .4), 0.8))));
  }
  set_threads(0);
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(Fracture, keeps_the_invariants_in_repeated_breaks_at_many_places) {
  const Compound wall = grid_compound(6, 6, 1, Vec3(0.4, 0.3, 0.2), true);
  std::vector<Compound> solids{wall};
  double debris = 0;
  Random random(3);
  std::uint64_t event = 1;
  for (int round = 0; round < 60; ++round) {
    const std::size_t which = random.below(static_cast<std::uint32_t>(solids.size()));
    const Compound solid = solids[which];
    const Box box = bounds(solid);
    const Vec3 at =
        box.min +
        Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(box.extent());
    const double radius = 0.4 * box.extent().norm();
    const BreakPlan plan = break_compound(solid, impact(voronoi(12), at, radius, ++event));
    ASSERT_EQ(find_violation(solid, plan), "") << "round " << round;
    ASSERT_EQ(plan.failed, 0u);
    debris += plan.debris_volume_m3;
    solids[which] = plan.pieces[0];
    solids.insert(solids.end(), plan.pieces.begin() + 1, plan.pieces.end());
  }
  double sum = debris;
  for (const Compound& solid : solids) sum += volume(solid);
  EXPECT_NEAR(sum, volume(wall), 1e-11 * volume(wall));
  EXPECT_GT(solids.size(), 200u);
}

TEST(Fracture, reports_all_new_area_as_exposed) {
  const Compound bricks = grid_compound(3, 3, 3);
  const BreakPlan plan =
      break_compound(bricks, impact(voronoi(30), Vec3(1.5, 1.5, 1.5), kInfinity));
  double exposed = 0;
  for (const ExposedFace& face : plan.exposed) {
    const ConvexPolyhedron& polyhedron = plan.pieces[face.piece].convexes[face.convex]->polyhedron;
    EXPECT_LE(face.area_m2, face_area(polyhedron, face.face) * (1 + 1e-9));
    exposed += face.area_m2;
  }
  EXPECT_NEAR(exposed, 2 * plan.new_area_m2, 1e-12 * exposed);
  double surface = 0;  // Surface of all pieces, minus the faces hidden inside them.
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) {
      for (std::size_t f = 0; f < convex->polyhedron.faces.size(); ++f) {
        surface += face_area(convex->polyhedron, f);
      }
    }
    for (const Bond& bond : piece.bonds) surface -= 2 * bond.area_m2;
  }
  EXPECT_NEAR(surface, 6 * 9 + exposed, 1e-9 * surface);
}

TEST(Fracture, keeps_anchored_only_pieces_at_the_anchored_side) {
  const Compound block = box_compound(Vec3(-1, 0, -1), Vec3(1, 2, 1), 1);
  const BreakPlan plan = break_compound(block, impact(voronoi(40), Vec3(0, 1, 0), kInfinity));
  std::size_t anchored = 0;
  for (const Compound& piece : plan.pieces) {
    const bool reaches = bounds(piece).min.y() < 1e-9;
    EXPECT_EQ(piece.is_anchored(), reaches);
    anchored += reaches;
  }
  EXPECT_GT(anchored, 0u);
  EXPECT_LT(anchored, plan.pieces.size());
}

}  // namespace
}  // namespace sunder::fracture
