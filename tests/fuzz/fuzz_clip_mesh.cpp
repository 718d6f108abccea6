// Fuzz target: a sequence of planes cuts a mesh that is not convex into watertight pieces and
// islands whose volumes sum to the whole. The first byte chooses the mesh.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/mesh_islands.h"
#include "tests/engine/geometry_mesh_fixtures.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/planes.h"

namespace sunder {
namespace {

using test::volume;

PolygonMesh some_mesh(std::uint8_t byte) {
  switch (byte % 4) {
    case 0:
      return test::comb(2 + byte / 4 % 5);
    case 1:
      return test::ring();
    case 2:
      return test::hollow_box();
    default:
      return test::torus(3u + byte / 4 % 8, 3u + byte / 32);
  }
}

PolygonMesh part(const PolygonMesh& mesh, const Plane& plane, PlaneId id, double tolerance) {
  MeshClipScratch scratch;
  PolygonMesh result;
  const PlaneSide side = clip(mesh, plane, id, tolerance, result, scratch);
  if (side == PlaneSide::kInside) return mesh;
  if (side == PlaneSide::kOutside) return {};
  SUNDER_CHECK(open_edges(result) == 0);
  SUNDER_CHECK(result.corner_normals.size() == result.corners.size());
  return result;
}

void cut_mesh(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  PolygonMesh mesh = some_mesh(bytes[0]);
  bytes = bytes.subspan(1);
  const std::size_t planes = std::min<std::size_t>(16, bytes.size() / fuzz::kPlaneBytes);
  double worst_tolerance = 0;
  for (std::size_t i = 0; i < planes; ++i) {
    const fuzz::Step step = fuzz::read_step(bytes.data() + i * fuzz::kPlaneBytes, mesh);
    worst_tolerance = std::max(worst_tolerance, step.tolerance);
    const double slack = 1e-13 + 40 * worst_tolerance;
    PolygonMesh inside = part(mesh, step.plane, {2}, step.tolerance);
    PolygonMesh outside = part(mesh, step.plane.flipped(), {3}, step.tolerance);
    SUNDER_CHECK(std::abs(volume(inside) + volume(outside) - volume(mesh)) <= slack);
    SUNDER_CHECK(volume(inside) > -slack && volume(outside) > -slack);
    const bool keep_inside = outside.empty() || (step.keep_inside && !inside.empty());
    mesh = keep_inside ? std::move(inside) : std::move(outside);
  }
  double sum = 0;
  for (const PolygonMesh& island : islands(mesh)) {
    SUNDER_CHECK(open_edges(island) == 0);
    sum += volume(island);
  }
  SUNDER_CHECK(std::abs(sum - volume(mesh)) <= 1e-13 + 40 * worst_tolerance);
}

const fuzz::Registration clip_mesh_target("clip_mesh", cut_mesh);

}  // namespace
}  // namespace sunder
