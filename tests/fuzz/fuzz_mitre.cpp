// Fuzz target: a convex cut from a box gets any of its faces mitred in any plane. The result is
// closed, lies within its other planes, and has at least the volume that was inside the new plane.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/mitre.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/planes.h"

namespace sunder {
namespace {

/// Largest coordinate of a solid that is mitred again: mitres of mitres grow.
constexpr double kMaxCoordinate = 1e3;

double farthest_coordinate(const ConvexPolyhedron& solid) {
  const Box box = bounds(solid);
  return std::max(box.max.maxCoeff(), -box.min.minCoeff());
}

double volume_within(const ConvexPolyhedron& solid, const Plane& plane, double tolerance) {
  ClipScratch scratch;
  ConvexPolyhedron result;
  const PlaneSide side = clip(solid, plane, {2}, tolerance, result, scratch);
  if (side == PlaneSide::kOutside) return 0;
  return mass_properties(side == PlaneSide::kInside ? solid : result).volume_m3;
}

/// Returns the solid with its face `front` mitred in the step's plane; empty if nothing is left.
ConvexPolyhedron mitred(const ConvexPolyhedron& solid, std::uint32_t front, const fuzz::Step& step,
                        double worst_tolerance) {
  MitreScratch scratch;
  ConvexPolyhedron result;
  const ColumnCell column[] = {{&solid, front}};
  if (!mitre(column, step.plane, {4}, step.tolerance, result, scratch)) return {};
  const double size = std::max({1.0, farthest_coordinate(solid), farthest_coordinate(result)});
  const double slack = (1e-13 + 40 * worst_tolerance) * size;
  SUNDER_CHECK(is_closed(result));
  SUNDER_CHECK(result.corner_normals.size() == result.corners.size());
  for (const Vec3& v : result.vertices) {
    SUNDER_CHECK(step.plane.distance(v) <= slack);
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      const Plane& plane = solid.faces[f].plane;
      const bool is_front = plane.normal == solid.faces[front].plane.normal;
      SUNDER_CHECK(is_front || plane.distance(v) <= slack);
    }
  }
  SUNDER_CHECK(mass_properties(result).volume_m3 >=
               volume_within(solid, step.plane, step.tolerance) - slack * size * size);
  return result;
}

/// Cuts a box by planes; a step that keeps the outside of its plane mitres a face in it instead.
void mitre_faces(std::span<const std::uint8_t> bytes) {
  ConvexPolyhedron solid = make_box(-Vec3::Ones(), Vec3::Ones()), cut;
  ClipScratch scratch;
  double worst_tolerance = 0;
  const std::size_t planes = std::min(fuzz::kMaxPlanes, bytes.size() / fuzz::kPlaneBytes);
  for (std::size_t i = 0; i < planes && farthest_coordinate(solid) < kMaxCoordinate; ++i) {
    const std::uint8_t* at = bytes.data() + i * fuzz::kPlaneBytes;
    const fuzz::Step step = fuzz::read_step(at, solid);
    worst_tolerance = std::max(worst_tolerance, step.tolerance);
    if (step.keep_inside) {
      if (clip(solid, step.plane, {2}, step.tolerance, cut, scratch) == PlaneSide::kCut) {
        std::swap(solid, cut);
      }
      continue;
    }
    const auto front = static_cast<std::uint32_t>(at[7] % solid.faces.size());
    ConvexPolyhedron left = mitred(solid, front, step, worst_tolerance);
    if (!left.empty()) solid = std::move(left);
  }
}

const fuzz::Registration mitre_target("mitre", mitre_faces);

}  // namespace
}  // namespace sunder
