// Fuzz target: a sequence of planes cuts a box into closed pieces whose volumes sum to the whole.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/convex_polyhedron.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/planes.h"

namespace sunder {
namespace {

ConvexPolyhedron part(const ConvexPolyhedron& solid, const Plane& plane, PlaneId id,
                      double tolerance, double slack) {
  ClipScratch scratch;
  ConvexPolyhedron result;
  const PlaneSide side = clip(solid, plane, id, tolerance, result, scratch);
  if (side == PlaneSide::kInside) return solid;
  if (side == PlaneSide::kOutside) return {};
  SUNDER_CHECK(is_closed(result));
  SUNDER_CHECK(result.corner_normals.size() == result.corners.size());
  SUNDER_CHECK(mass_properties(result).volume_m3 > -slack);
  for (const ConvexPolyhedron::Face& face : result.faces) {
    for (const Vec3& v : result.vertices) SUNDER_CHECK(face.plane.distance(v) <= slack);
  }
  return result;
}

void cut_box(std::span<const std::uint8_t> bytes) {
  ConvexPolyhedron solid = make_box(-Vec3::Ones(), Vec3::Ones());
  double worst_tolerance = 0;
  const std::size_t planes = std::min(fuzz::kMaxPlanes, bytes.size() / fuzz::kPlaneBytes);
  for (std::size_t i = 0; i < planes; ++i) {
    const fuzz::Step step = fuzz::read_step(bytes.data() + i * fuzz::kPlaneBytes, solid);
    worst_tolerance = std::max(worst_tolerance, step.tolerance);
    const double slack = 1e-13 + 20 * worst_tolerance;
    const PlaneId id{2 * i + 2};
    ConvexPolyhedron inside = part(solid, step.plane, id, step.tolerance, slack);
    ConvexPolyhedron outside =
        part(solid, step.plane.flipped(), id.opposite(), step.tolerance, slack);
    const double sum = mass_properties(inside).volume_m3 + mass_properties(outside).volume_m3;
    SUNDER_CHECK(std::abs(sum - mass_properties(solid).volume_m3) <= slack);
    SUNDER_CHECK(!inside.empty() || !outside.empty());
    const bool keep_inside = outside.empty() || (step.keep_inside && !inside.empty());
    solid = keep_inside ? std::move(inside) : std::move(outside);
  }
}

const fuzz::Registration clip_target("clip", cut_box);

}  // namespace
}  // namespace sunder
