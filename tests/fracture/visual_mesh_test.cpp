// Tests that meshes from files break into pieces that keep every invariant.
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/vacd/vacd.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/visual_truths.h"
#include "tests/mesh/mesh_files.h"

namespace sunder::fracture {
namespace {

RepairedMesh read_repaired(const std::filesystem::path& file) {
  return repair_mesh(read_mesh(file), file.filename().string());
}

BreakCommand impact(int cells, const Vec3& at, double radius_m, std::uint64_t event = 1) {
  BreakCommand command;
  command.event = command.seed = event;
  command.pattern.kind = PatternSpec::Kind::kVoronoi;
  command.pattern.cells = cells;
  command.pattern.falloff = 1;
  command.X_RP.position = at;
  command.radius_m = radius_m;
  return command;
}

TEST(RealMeshes, keep_every_invariant_when_they_break) {
  for (const auto& file : test::meshes("good")) {
    const std::string name = file.filename().string();
    for (PolygonMesh& shell : read_repaired(file).shells) {
      const Compound solid = solid_of(std::move(shell));
      for (const int cells : {1, 20, 100}) {
        const Vec3 center = bounds(solid).center();
        const BreakPlan plan =
            break_compound(solid, impact(cells, center, std::numeric_limits<double>::infinity()));
        EXPECT_EQ(find_visual_violation(solid, plan), "") << name << " in " << cells;
        EXPECT_EQ(plan.failed, 0u) << name << " in " << cells;
        EXPECT_LT(plan.debris_volume_m3, 1e-5 * volume(solid)) << name << " in " << cells;
        EXPECT_EQ(plan.broke(), cells > 1) << name << " in " << cells;
      }
    }
  }
}

TEST(RealMeshes, keep_every_invariant_over_three_levels) {
  const RepairedMesh mesh = read_repaired(test::made_file("ball"));
  std::vector<Compound> solids{solid_of(mesh.shells[0])};
  const double whole = volume(solids[0]);
  double debris = 0;
  std::uint64_t event = 0;
  std::size_t internal = 0;
  for (int level = 0; level < 3; ++level) {
    std::vector<Compound> next;
    for (const Compound& solid : solids) {
      ++event;
      const BreakPlan plan = break_compound(
          solid, impact(8, bounds(solid).center(), std::numeric_limits<double>::infinity(), event));
      ASSERT_EQ(find_visual_violation(solid, plan), "") << "event " << event;
      ASSERT_EQ(plan.failed, 0u) << "event " << event;
      debris += plan.debris_volume_m3;
      next.insert(next.end(), plan.pieces.begin(), plan.pieces.end());
    }
    solids = std::move(next);
  }
  double sum = debris;
  for (const Compound& solid : solids) {
    sum += volume(solid);
    for (const ConvexPtr& convex : solid.convexes) internal += convex->is_internal();
  }
  EXPECT_NEAR(sum, whole, 1e-12 * whole);
  EXPECT_GT(solids.size(), 250u);
  EXPECT_GT(internal, 0u);
  std::printf("%zu pieces, %zu internal convexes, debris %.1e\n", solids.size(), internal,
              debris / whole);
}

TEST(RealMeshes, break_where_they_are_hit_and_nowhere_else) {
  VacdOptions options;
  options.node_count = 12;
  const Compound solid = decompose(read_repaired(test::made_file("ball")), options).compound;
  BreakPlan unbroken;
  unbroken.pieces = {solid};
  EXPECT_EQ(find_visual_violation(solid, unbroken), "");
  EXPECT_GE(solid.bonds.size(), 12u);
  const Box box = bounds(solid);
  const BreakCommand command =
      impact(30, box.center() + 0.3 * box.extent(), 0.15 * box.extent().norm());
  const BreakPlan plan = break_compound(solid, command);
  ASSERT_TRUE(plan.broke());
  EXPECT_EQ(find_visual_violation(solid, plan), "");
  const ImpactSphere sphere{command.X_RP.position, command.radius_m};
  std::size_t untouched = 0;
  for (const ConvexPtr& convex : solid.convexes) {
    if (sphere.touches(*convex)) continue;
    ++untouched;
    const bool is_kept =
        std::any_of(plan.pieces.begin(), plan.pieces.end(), [&](const Compound& piece) {
          return std::find(piece.convexes.begin(), piece.convexes.end(), convex) !=
                 piece.convexes.end();
        });
    EXPECT_TRUE(is_kept);
  }
  EXPECT_GT(untouched, 2u);
}

TEST(RealMeshes, break_alike_with_any_number_of_threads) {
  VacdOptions options;
  options.node_count = 5;
  const Compound solid = decompose(read_repaired(test::made_file("knot")), options).compound;
  std::vector<std::uint64_t> hashes;
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    const BreakPlan plan = break_compound(
        solid, impact(60, bounds(solid).center(), 0.3 * bounds(solid).extent().norm()));
    EXPECT_TRUE(plan.broke());
    hashes.push_back(hash_of(plan));
  }
  set_threads(0);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace sunder::fracture
