// Convex polyhedra: polygons on named planes, with one normal per corner for shading (paper 3.1).
//
// Read first: ConvexPolyhedron, then clip() (clip.h). Everything is in the rest frame R of the
// solid that the convex was cut from, and stays there through every generation of fracture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/plane.h"

namespace sunder {

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
/// An axis-aligned box, flat-shaded.
ConvexPolyhedron make_box(const Vec3& min, const Vec3& max);
/// A convex polygon in the xz-plane (counter-clockwise seen from +y) swept from `bottom` to `top`
/// along y; `smooth` shades the sides round (for columns).
ConvexPolyhedron make_prism(std::span<const Vec2> polygon_xz, double bottom, double top,
                            bool smooth);
/// The same solid moved rigidly; plane ids are kept.
ConvexPolyhedron transformed(const ConvexPolyhedron& convex, const Pose& X_RQ);

/// Whether every directed edge has its opposite exactly once and V − E + F = 2.
bool is_closed(const ConvexPolyhedron& convex);

}  // namespace sunder
