// Any sequence of planes, near-degenerate ones above all, cuts a box into closed pieces that make
// up the whole. Each byte string is one sequence; each plane takes eight bytes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/convex_polyhedron.h"

namespace sunder {
namespace {

constexpr std::size_t kPlaneBytes = 8;
constexpr std::size_t kMostPlanes = 64;
constexpr double kTolerances[] = {0, 0, 1e-13, 1e-9};

/// What eight bytes say: a plane, how wide its tolerance is and which side goes on.
struct Step {
  Plane plane;
  double tolerance = 0;
  bool keep_inside = true;
};

Vec3 some_vertex(const ConvexPolyhedron& solid, std::uint8_t byte) {
  return solid.vertices[byte % solid.vertices.size()];
}

/// One of four kinds: anywhere, on a coarse grid, almost a face, through three vertices.
Plane read_plane(const std::uint8_t* bytes, const ConvexPolyhedron& solid) {
  const auto number = [&](int i) {
    return static_cast<double>(static_cast<std::int8_t>(bytes[i]));
  };
  const auto step = [&](int i) { return static_cast<double>(bytes[i] % 5) - 2; };
  Vec3 normal, point;
  switch (bytes[0] & 3) {
    case 0:
      normal = Vec3(number(1), number(2), number(3));
      point = Vec3(number(4), number(5), number(6) + number(7) / 128) / 128;
      break;
    case 1:
      normal = Vec3(step(1), step(2), step(3));
      point = Vec3(step(4), step(5), step(6)) / 2;
      break;
    case 2: {
      const Plane face = solid.faces[bytes[1] % solid.faces.size()].plane;
      const Vec3 turn(number(2), number(3), number(4));
      normal = face.normal + std::ldexp(1.0, -30 - bytes[5] % 32) * turn;
      point = some_vertex(solid, bytes[6]) - std::ldexp(number(7), -50) * face.normal;
      break;
    }
    default: {
      point = some_vertex(solid, bytes[1]);
      const Vec3 along = some_vertex(solid, bytes[2]) - point;
      normal = along.cross(some_vertex(solid, bytes[3]) - point) +
               std::ldexp(number(4), -40) * Vec3(step(5), step(6), step(7));
    }
  }
  const double length = normal.norm();
  return Plane::through(point, length > 1e-100 ? Vec3(normal / length) : Vec3::UnitY());
}

Step read_step(const std::uint8_t* bytes, const ConvexPolyhedron& solid) {
  return {read_plane(bytes, solid), kTolerances[bytes[0] >> 2 & 3], (bytes[0] & 16) != 0};
}

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
  for (std::size_t i = 0; i < kMostPlanes && bytes.size() >= (i + 1) * kPlaneBytes; ++i) {
    const Step step = read_step(bytes.data() + i * kPlaneBytes, solid);
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

}  // namespace
}  // namespace sunder

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sunder::cut_box({data, size});
  return 0;
}
