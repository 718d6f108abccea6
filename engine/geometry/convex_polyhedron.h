// Convex polyhedra: polygons on identified planes, with shading normals for corners (paper 3.1).
//
// Begin with ConvexPolyhedron, then clip() (clip.h). All coordinates are in the rest frame R of the
// original solid, also after any number of fractures.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// The half-space n·x + d <= 0. The normal has unit length and points out of the half-space.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double d = 0;

  /// Returns the signed distance in metres, positive outside.
  double distance(const Vec3& point) const { return normal.dot(point) + d; }
  /// Returns the complementary half-space.
  Plane flipped() const { return {-normal, -d}; }
  /// Returns the half-space whose plane contains `point`.
  static Plane through(const Vec3& point, const Vec3& unit_normal) {
    return {unit_normal, -unit_normal.dot(point)};
  }
};

/// Identifies one side of a plane in a compound and its pieces: faces a and b lie in one plane with
/// opposite normals exactly if a == b.opposite(). Zero means none.
struct PlaneId {
  std::uint64_t value = 0;

  /// Returns the id of the other side of the plane.
  constexpr PlaneId opposite() const { return {value ^ 1}; }
  /// Returns true for the id of no plane.
  constexpr bool none() const { return value == 0; }
  constexpr auto operator<=>(const PlaneId&) const = default;
};

/// Position of a solid relative to a plane.
enum class PlaneSide { kInside, kOutside, kCut };

/// Mass properties for density 1; mass and inertia are proportional to the density.
struct MassProperties {
  double volume_m3 = 0;
  Vec3 centroid = Vec3::Zero();
  /// S = ∫ r rᵀ dV about the centroid (symmetric, in m⁵).
  Mat3 second_moment = Mat3::Zero();

  /// Returns the inertia tensor for density 1, trace(S)·I − S.
  Mat3 inertia() const { return second_moment.trace() * Mat3::Identity() - second_moment; }
};

/// Returns the properties of the union of two disjoint solids (parallel-axis theorem).
MassProperties operator+(const MassProperties& a, const MassProperties& b);

/// Origin of a face: the original surface, or the interior exposed by a break.
enum class FaceKind : std::uint8_t { kSurface, kInterior };

/// A closed convex polyhedron. Faces are polygons, counter-clockwise seen from outside; every
/// directed edge has its opposite exactly once. The corners of face f are corner_count elements of
/// `corners` and `corner_normals` from first_corner on.
struct ConvexPolyhedron {
  /// A polygon in a plane.
  struct Face {
    Plane plane;
    PlaneId id;
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
    FaceKind kind = FaceKind::kSurface;
  };

  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<std::uint32_t> corners;  ///< Vertex index of each corner.
  std::vector<Vec3f> corner_normals;   ///< Unit shading normal of each corner.

  /// Returns true if there is no face.
  bool empty() const { return faces.empty(); }
  /// Returns the vertex indices of face `f`.
  std::span<const std::uint32_t> face_corners(std::size_t f) const {
    return std::span(corners).subspan(faces[f].first_corner, faces[f].corner_count);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

/// Returns the bounding box.
Box bounds(const ConvexPolyhedron& convex);
/// Returns the mass properties for density 1; all zero if the convex is empty.
MassProperties mass_properties(const ConvexPolyhedron& convex);
/// Returns the area of a face in m².
double face_area(const ConvexPolyhedron& convex, std::size_t face);

/// Appends a flat-shaded kSurface face without id, on the plane that fits the corners best.
void add_face(ConvexPolyhedron& convex, std::span<const std::uint32_t> corners);
/// Returns a flat-shaded axis-aligned box. Throws InputError unless min < max and both are finite.
ConvexPolyhedron make_box(const Vec3& min, const Vec3& max);
/// Returns the prism over a convex polygon in the xz-plane, counter-clockwise seen from +y, from
/// `bottom` to `top` along y. `smooth` shades the sides as a round surface (for columns). Throws
/// InputError if the polygon has fewer than three corners or runs clockwise, or if bottom >= top.
ConvexPolyhedron make_prism(std::span<const Vec2> polygon_xz, double bottom, double top,
                            bool smooth);
/// Returns the convex under a rigid transform; plane ids are kept.
ConvexPolyhedron transformed(const ConvexPolyhedron& convex, const Pose& X_RQ);

/// The method that fits a convex to the points it encloses (approximate_hull.h).
struct Fit {
  /// Bounding box, polytope of 14 or 26 fixed directions, or simplified hull.
  enum class Kind : std::uint8_t { kAabb, k14Dop, k26Dop, kHull };
  Kind kind = Kind::k26Dop;
  std::uint32_t vertex_count = 24;  ///< Number of vertices of the hull, for kHull.
};

/// Returns true if every directed edge has its opposite exactly once and V − E + F = 2.
bool is_closed(const ConvexPolyhedron& convex);

}  // namespace sunder
