// Tests that repaired meshes are cut into watertight halves whose volumes add up.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"
#include "tests/mesh/mesh_files.h"

namespace sunder {
namespace {

double volume_inside(const PolygonMesh& mesh, const Plane& plane, PlaneId id) {
  PolygonMesh half;
  MeshClipScratch scratch;
  switch (clip(mesh, plane, id, 0, half, scratch)) {
    case PlaneSide::kInside:
      return mass_properties(mesh).volume_m3;
    case PlaneSide::kOutside:
      return 0;
    case PlaneSide::kCut:
      EXPECT_EQ(open_edges(half), 0u);
      return mass_properties(half).volume_m3;
  }
  return 0;
}

void expect_cuts_add_up(const std::vector<PolygonMesh>& shells, const std::string& name) {
  Random random(11);
  for (const PolygonMesh& shell : shells) {
    const Box box = bounds(shell);
    const double whole = mass_properties(shell).volume_m3;
    for (int i = 0; i < 3; ++i) {
      const Vec3 offset(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
                        random.uniform(-0.3, 0.3));
      const Vec3 direction = i == 0 ? Vec3(Vec3::UnitY()) : random.direction();
      const Plane plane =
          Plane::through(box.center() + box.extent().cwiseProduct(offset), direction);
      const double sum =
          volume_inside(shell, plane, {2}) + volume_inside(shell, plane.flipped(), {3});
      // The tolerance is relative to the box where the volume is a small difference of large parts.
      EXPECT_NEAR(sum, whole, 1e-12 * std::max(whole, box.extent().prod())) << name;
    }
  }
}

TEST(RepairedMeshes, AreCutIntoHalvesThatAddUp) {
  for (const std::string set : {"good", "nasty"}) {
    for (const auto& file : test::meshes(set)) {
      const std::string name = file.filename().string();
      try {
        expect_cuts_add_up(repair_mesh(read_mesh(file), name).shells, name);
      } catch (const InputError&) {
        EXPECT_EQ(set, "nasty") << name;
      }
    }
  }
}

}  // namespace
}  // namespace sunder
