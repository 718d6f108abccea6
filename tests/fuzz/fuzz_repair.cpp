// Any polygons over the points of a small lattice, where everything that can coincide does: repair
// ends with watertight solids, or with an InputError.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/base/check.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/repair.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 400) return 0;
  sunder::RawMesh mesh;
  for (int i = 0; i < 64; ++i) mesh.vertices.emplace_back(i % 4, i / 4 % 4, i / 16);
  // The lattice's points are slightly off for one half of the inputs.
  const bool bent = size > 0 && (data[0] & 1) != 0;
  for (sunder::Vec3& p : mesh.vertices)
    p += bent ? 1e-7 * p.cwiseProduct(p) : sunder::Vec3(0, 0, 0);
  std::vector<std::uint32_t> polygon;
  for (std::size_t i = 1; i < size; ++i) {
    polygon.push_back(data[i] & 63u);
    if ((data[i] & 64) == 0 && i + 1 < size) continue;
    sunder::append_polygon(mesh, polygon, 0);
    polygon.clear();
  }
  try {
    const sunder::RepairedMesh repaired = sunder::repair_mesh(mesh, "lattice", {.shell_cells = 6});
    SUNDER_CHECK(!repaired.shells.empty());
    for (const sunder::PolygonMesh& shell : repaired.shells) {
      SUNDER_CHECK(sunder::open_edges(shell) == 0);
      SUNDER_CHECK(std::isfinite(sunder::mass_properties(shell).volume_m3));
      for (const sunder::Vec3f& n : shell.corner_normals) SUNDER_CHECK(n.allFinite());
    }
  } catch (const sunder::InputError&) {
  }
  return 0;
}
