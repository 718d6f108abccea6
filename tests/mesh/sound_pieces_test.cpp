// Tests that the pieces of generated meshes, and of real ones if they exist, have sound surfaces.
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/check/audit.h"
#include "fracture/vacd/vacd.h"
#include "tests/fracture/break_compound.h"
#include "tests/mesh/mesh_damage.h"
#include "tests/mesh/mesh_files.h"

namespace sunder {
namespace {

using Kind = PatternSpec::Kind;
struct Pattern {
  const char* name;
  Kind kind;
  int cells;
};
constexpr Pattern kPatterns[] = {
    {"voronoi:20", Kind::kVoronoi, 20}, {"slabs:6", Kind::kSlabs, 6}, {"grid:3", Kind::kGrid, 3}};

/// Returns the break of a compound by a pattern of unlimited radius about its centre.
BreakPlan broken(const Compound& compound, const Pattern& pattern) {
  BreakCommand command;
  command.event = command.seed = 1;
  command.pattern.kind = pattern.kind;
  command.pattern.cells = pattern.cells;
  command.X_RP.position = bounds(compound).center();
  command.radius_m = std::numeric_limits<double>::infinity();
  return fracture::break_compound(compound, command);
}

/// Returns a line with what is wrong with the pieces; empty if each is the surface of a solid and
/// no volume is lost or hidden.
std::string faults_of(const BreakPlan& plan, const Compound& whole) {
  const fracture::Audit audit = fracture::audit(plan.pieces);
  std::ostringstream text;
  const auto add = [&](const char* what, double count) {
    if (count > 0) text << ' ' << count << ' ' << what << ',';
  };
  add("walled", static_cast<double>(audit.walled_pieces));
  add("open edges", static_cast<double>(audit.surface.open_edges));
  add("non-manifold edges", static_cast<double>(audit.surface.non_manifold_edges));
  add("twins", static_cast<double>(audit.surface.twin_points));
  add("collapsed", static_cast<double>(audit.surface.collapsed_triangles));
  add("inside out", static_cast<double>(audit.surface.inside_out_islands));
  add("m³ inside out", audit.surface.inside_out_m3);
  add("not watertight", static_cast<double>(audit.pieces - audit.watertight_pieces));
  add("m³ of negative debris", -plan.debris_volume_m3);
  const double whole_m3 = fracture::audit(std::span(&whole, 1)).volume_m3;
  const double error = std::abs(audit.volume_m3 + plan.debris_volume_m3 - whole_m3) / whole_m3;
  if (!(error <= 1e-11)) add("of the volume", error);
  return text.str();
}

/// Breaks a mesh and returns the faults of its pieces; none if the mesh encloses no volume.
std::optional<std::string> faults_of(RawMesh mesh, const Pattern& pattern) {
  RepairedMesh repaired;
  try {
    repaired = repair_mesh(std::move(mesh), "mesh");
  } catch (const InputError&) {
    return std::nullopt;
  }
  const Compound compound = fracture::decompose(repaired).compound;
  if (compound.convexes.empty()) return std::nullopt;
  return faults_of(broken(compound, pattern), compound);
}

/// Seeds of meshes of which a piece still has a fault: two that pass through themselves, so that a
/// part of 0.2 % of the volume is inside out within a convex, and one with a neck of 1.3e-9 m.
constexpr std::uint64_t kFaultySeeds[] = {99, 129, 351};

TEST(SoundPieces, OfFiveHundredGeneratedMeshes) {
  int broken_meshes = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Pattern& pattern = kPatterns[seed % std::size(kPatterns)];
    const std::optional<std::string> faults = faults_of(test::make_hard_mesh(seed), pattern);
    if (!faults) continue;
    ++broken_meshes;
    const bool is_faulty = std::ranges::count(kFaultySeeds, seed) > 0;
    EXPECT_EQ(faults->empty(), !is_faulty) << "seed " << seed << ", " << pattern.name << *faults;
  }
  EXPECT_GE(broken_meshes, 450);
}

TEST(SoundPieces, OfRealMeshes) {
  if (!std::filesystem::exists(test::real_meshes_folder()))
    GTEST_SKIP() << "no folder of real meshes: set SUNDER_MESHES";
  for (const std::string set : {"good", "nasty"}) {
    for (const auto& file : test::meshes(set)) {
      RawMesh mesh;
      try {
        mesh = read_mesh(file);
      } catch (const InputError&) {
        EXPECT_EQ(set, "nasty") << file;
        continue;
      }
      const std::string name = file.filename().string();
      EXPECT_EQ(faults_of(std::move(mesh), kPatterns[0]).value_or(""), "") << name;
    }
  }
}

}  // namespace
}  // namespace sunder
