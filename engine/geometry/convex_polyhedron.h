// Convex polyhedra: polygons on named planes, with one normal per corner for shading (paper 3.1).
//
// Read first: ConvexPolyhedron, then clip() (clip.h). Everything is in the rest frame R of the
// solid that the convex was cut from, and stays there through every generation of fracture.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// The half-space n·x + d <= 0; the normal has unit length and points out of it.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double d = 0;

  /// Signed, in metres: positive outside.
  double distance(const Vec3& point) const { return normal.dot(point) + d; }
  /// The other half-space.
  Plane flipped() const { return {-normal, -d}; }
  static Plane through(const Vec3& point, const Vec3& unit_normal) {
    return {unit_normal, -unit_normal.dot(point)};
  }
};

/// Names one side of a plane within a compound's lineage: faces a and b lie in one plane with
/// opposite normals iff a == b.opposite(). Zero is "not named yet".
struct PlaneId {
  std::uint64_t value = 0;

  constexpr PlaneId opposite() const { return {value ^ 1}; }
  constexpr bool none() const { return value == 0; }
  constexpr auto operator<=>(const PlaneId&) const = default;
};

/// Where a solid lies relative to a plane.
enum class PlaneSide { kInside, kOutside, kCut };

/// Of a solid of density 1: multiply volume and second moment by the density for mass and inertia.
struct MassProperties {
  double volume_m3 = 0;
  Vec3 centroid = Vec3::Zero();
  /// ∫ r rᵀ dV about the centroid (symmetric, m⁵); inertia = trace(S)·I − S.
  Mat3 second_moment = Mat3::Zero();

  Mat3 inertia() const { return second_moment.trace() * Mat3::Identity() - second_moment; }
};

/// The union of two solids that do not overlap (parallel-axis theorem).
MassProperties operator+(const MassProperties& a, const MassProperties& b);

/// What a face looks like: part of the original surface, or made by a break.
enum class FaceKind : std::uint8_t { kSurface, kInterior };

/// A closed convex solid. Faces are polygons, counter-clockwise seen from outside; every directed
/// edge has its opposite exactly once. Corners of face f are
/// [faces[f].first_corner, +corner_count) of `corners` and `corner_normals`.
struct ConvexPolyhedron {
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

  bool empty() const { return faces.empty(); }
  std::span<const std::uint32_t> face_corners(std::size_t f) const {
    return std::span(corners).subspan(faces[f].first_corner, faces[f].corner_count);
  }
};

/// The least box around it.
Box bounds(const ConvexPolyhedron& convex);
/// Of the solid; all zero if it is empty.
MassProperties mass_properties(const ConvexPolyhedron& convex);
/// In m².
double face_area(const ConvexPolyhedron& convex, std::size_t face);

/// Appends a flat-shaded surface face on the plane that fits the corners best; no id.
void add_face(ConvexPolyhedron& convex, std::span<const std::uint32_t> corners);
/// An axis-aligned box, flat-shaded. Throws InputError unless min < max, both finite.
ConvexPolyhedron make_box(const Vec3& min, const Vec3& max);
/// A convex polygon in the xz-plane (counter-clockwise seen from +y) swept from `bottom` to `top`
/// along y; `smooth` shades the sides round (for columns). Throws InputError for anything else.
ConvexPolyhedron make_prism(std::span<const Vec2> polygon_xz, double bottom, double top,
                            bool smooth);
/// The same solid moved rigidly; plane ids are kept.
ConvexPolyhedron transformed(const ConvexPolyhedron& convex, const Pose& X_RQ);

/// How a convex is fitted to what it encloses; approximate_hull.h does it.
struct Fit {
  enum class Kind : std::uint8_t { kAabb, k14Dop, k26Dop, kHull };
  Kind kind = Kind::k26Dop;
  std::uint32_t vertex_count = 24;  ///< Of algorithm 1's hull, for kHull.
};

/// Whether every directed edge has its opposite exactly once and V − E + F = 2.
bool is_closed(const ConvexPolyhedron& convex);

}  // namespace sunder
