// Tests that meshes with any defect break into pieces of positive volume, or are refused.
#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/geometry/walls/outer_surface.h"
#include "fracture/check/audit.h"
#include "fracture/vacd/vacd.h"
#include "tests/fracture/break_compound.h"
#include "tests/mesh/made_meshes.h"
#include "tests/mesh/mesh_damage.h"

namespace sunder {
namespace {

using fracture::Vacd;

/// Breaks a compound by a pattern of unlimited radius about its centre.
BreakPlan break_all(const Compound& compound, PatternSpec::Kind kind, int cells) {
  BreakCommand command;
  command.event = command.seed = 1;
  command.pattern.kind = kind;
  command.pattern.cells = cells;
  command.X_RP.position = bounds(compound).center();
  command.radius_m = std::numeric_limits<double>::infinity();
  return fracture::break_compound(compound, command);
}

void expect_solids(const RawMesh& mesh, const std::string& name) {
  RepairedMesh repaired;
  try {
    repaired = repair_mesh(mesh, name);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("encloses no volume"), std::string::npos)
        << error.what();
    return;
  }
  const Vacd vacd = fracture::decompose(repaired);
  const fracture::Audit whole = fracture::audit(std::span(&vacd.compound, 1));
  EXPECT_EQ(whole.negative_volumes, 0u) << name << " before it breaks";
  EXPECT_EQ(whole.surface.open_edges, 0u) << name << " before it breaks";
  if (vacd.compound.convexes.empty()) return;
  using Kind = PatternSpec::Kind;
  for (const auto& [kind, cells] :
       {std::pair{Kind::kVoronoi, 20}, std::pair{Kind::kSlabs, 6}, std::pair{Kind::kGrid, 3}}) {
    const BreakPlan plan = break_all(vacd.compound, kind, cells);
    const fracture::Audit audit = fracture::audit(plan.pieces);
    EXPECT_EQ(audit.negative_volumes, 0u) << name;
    EXPECT_EQ(audit.surface.open_edges, 0u) << name;
    EXPECT_NEAR(audit.volume_m3 + plan.debris_volume_m3, whole.volume_m3, 1e-12 * whole.volume_m3)
        << name;
  }
}

TEST(HardMeshes, OfEveryDamageBreakIntoSolids) {
  for (int damage = 0; damage < test::kDamages; ++damage) {
    const auto kind = static_cast<test::Damage>(damage);
    for (const char* whole : {"frame", "star", "pebble"})
      expect_solids(test::damaged(test::make_good(whole), kind, 1),
                    std::string(whole) + ", " + test::name_of(kind));
  }
}

TEST(HardMeshes, MadeAtRandomBreakIntoSolids) {
  for (std::uint64_t seed = 0; seed < 60; ++seed)
    expect_solids(test::make_hard_mesh(seed), "hard mesh " + std::to_string(seed));
}

}  // namespace
}  // namespace sunder
