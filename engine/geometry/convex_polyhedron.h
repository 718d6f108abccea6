// Convex polyhedra: polygons on named planes, with one normal per corner for shading (paper 3.1).
//
// Read first: ConvexPolyhedron, then clip(). Everything is in the rest frame R of the solid that
// the convex was cut from, and stays there through every generation of fracture.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
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

Box bounds(const ConvexPolyhedron& convex);
MassProperties mass_properties(const ConvexPolyhedron& convex);
double face_area(const ConvexPolyhedron& convex, std::size_t face);

/// Appends a flat-shaded surface face on the plane that fits the corners best; no id.
void add_face(ConvexPolyhedron& convex, std::span<const std::uint32_t> corners);
/// An axis-aligned box, flat-shaded.
ConvexPolyhedron make_box(const Vec3& min, const Vec3& max);
/// A convex polygon in the xz-plane (counter-clockwise seen from +y) swept from `bottom` to `top`
/// along y; `smooth` shades the sides round (for columns).
ConvexPolyhedron make_prism(std::span<const Vec2> polygon_xz, double bottom, double top,
                            bool smooth);
/// The convex hull of points in general or degenerate position (coplanar faces merged),
/// flat-shaded. Empty if the points span no volume. For preparation, not for run time: clipping
/// knows the topology already.
ConvexPolyhedron make_hull(std::span<const Vec3> points);
/// The same solid moved rigidly; plane ids are kept.
ConvexPolyhedron transformed(const ConvexPolyhedron& convex, const Pose& X_RQ);

/// Where a convex lies relative to a plane.
enum class PlaneSide { kInside, kOutside, kCut };

/// Reused memory of clip(); one per thread.
struct ClipScratch {
  struct Crossing {
    std::uint32_t outside;  ///< The edge's vertex that is cut off.
    std::uint32_t vertex;   ///< Where it is cut, in the result.
    std::uint32_t next;     ///< Of the same inside vertex.
    double t;               ///< Place along the edge, from its lexicographically first end.
    bool inside_first;      ///< Which end that is.
  };
  std::vector<double> distances;
  std::vector<std::uint8_t> sides;            ///< Per vertex.
  std::vector<std::uint32_t> new_of_old;      ///< Per vertex.
  std::vector<std::uint32_t> first_crossing;  ///< Per inside vertex, heads of lists.
  std::vector<Crossing> crossings;
  std::vector<std::uint32_t> cap_next;  ///< Per new vertex: the cap's edges.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_edges;  ///< Kept, both ends on.
};

/// Keeps the part of a closed `convex` with plane.distance <= 0 in `result` (unspecified unless the
/// answer is kCut). The new face, the last, gets `id` and kInterior (where a sliver as thin as the
/// rounding is cut, it may be several faces or none). Topology follows from the vertices'
/// signs alone (distances within `tolerance_m` of the plane count as on it), so the result is
/// closed whatever the rounding; normals are interpolated along cut edges. A cut edge gives the
/// same bits from either side of the plane and in every convex that has the edge. A convex wholly
/// within tolerance is inside for exactly one of (plane, id) and (plane.flipped(), id.opposite()).
PlaneSide clip(const ConvexPolyhedron& convex, const Plane& plane, PlaneId id, double tolerance_m,
               ConvexPolyhedron& result, ClipScratch& scratch);

/// Whether every directed edge has its opposite exactly once and V − E + F = 2.
bool is_closed(const ConvexPolyhedron& convex);

}  // namespace sunder
