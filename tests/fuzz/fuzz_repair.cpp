// Fuzz target: repair of any polygons over the points of a small lattice, with many coincident
// vertices, edges and faces, gives watertight solids or an InputError.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/base/check.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/repair.h"
#include "tests/fuzz/fuzz_target.h"

namespace sunder {
namespace {

void repair_lattice(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > 400) return;
  RawMesh mesh;
  for (int i = 0; i < 64; ++i) mesh.vertices.emplace_back(i % 4, i / 4 % 4, i / 16);
  // Half of the inputs have the points of the lattice slightly displaced.
  const bool bent = !bytes.empty() && (bytes[0] & 1) != 0;
  for (Vec3& p : mesh.vertices) p += bent ? 1e-7 * p.cwiseProduct(p) : Vec3(0, 0, 0);
  std::vector<std::uint32_t> polygon;
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    polygon.push_back(bytes[i] & 63u);
    if ((bytes[i] & 64) == 0 && i + 1 < bytes.size()) continue;
    append_polygon(mesh, polygon, 0);
    polygon.clear();
  }
  try {
    const RepairedMesh repaired = repair_mesh(mesh, "lattice", {.shell_cells = 6});
    SUNDER_CHECK(!repaired.shells.empty());
    for (const PolygonMesh& shell : repaired.shells) {
      SUNDER_CHECK(open_edges(shell) == 0);
      SUNDER_CHECK(std::isfinite(mass_properties(shell).volume_m3));
      for (const Vec3f& n : shell.corner_normals) SUNDER_CHECK(n.allFinite());
    }
  } catch (const InputError&) {
  }
}

const fuzz::Registration repair_target("repair", repair_lattice);

}  // namespace
}  // namespace sunder
