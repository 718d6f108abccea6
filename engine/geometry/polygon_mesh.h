// Visual meshes: closed surfaces of general polygons, possibly non-convex and with holes, never
// permanently triangulated (paper 3.3, figure 9).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

using Vec2f = Eigen::Vector2f;

/// A surface of polygons in the rest frame R. A face has one outer contour, counter-clockwise seen
/// from outside, and any number of further contours (holes clockwise, islands counter-clockwise);
/// what is inside follows from even-odd counting. Faces made by cuts, the caps, follow all others.
/// Contours of face f are [first_contour, +contour_count) of `contours`; corners of a contour
/// likewise of the corner arrays, which run in parallel. All are in order without gaps: the
/// contours of face after face, the corners of contour after contour.
struct PolygonMesh {
  struct Contour {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
  };
  struct Face {
    Plane plane;
    PlaneId id;  ///< None on the original surface; that of the cut on a cap.
    std::uint32_t first_contour = 0;
    std::uint32_t contour_count = 0;
    FaceKind kind = FaceKind::kSurface;
    /// Kept through all cuts: of a mesh from a file the number of its group (RawMesh::groups), in a
    /// scene that of its paint (Scene::paints), from 1; 0: none.
    std::uint32_t mark = 0;
  };

  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<Contour> contours;
  std::vector<std::uint32_t> corners;  ///< Vertex index of each corner.
  std::vector<Vec3f> corner_normals;   ///< Unit shading normal of each corner.
  std::vector<Vec2f> corner_uvs;       ///< Texture coordinates; empty if there are none.

  bool empty() const { return faces.empty(); }
  std::span<const std::uint32_t> contour_corners(std::size_t c) const {
    return std::span(corners).subspan(contours[c].first_corner, contours[c].corner_count);
  }
};

/// The first of the caps, or the number of faces if there are none.
std::size_t first_cap(const PolygonMesh& mesh);
/// In m²; holes do not count.
double face_area(const PolygonMesh& mesh, std::size_t face);
/// The surface of a convex.
PolygonMesh polygon_mesh(const ConvexPolyhedron& convex);
/// Texture coordinates along a plane's two flattest axes, in metres of the rest frame.
Vec2f planar_uv(const Vec3& point, const Vec3& normal);
/// The least box around it.
Box bounds(const PolygonMesh& mesh);
/// Of the enclosed solid (divergence theorem); meaningful only if the mesh is watertight.
MassProperties mass_properties(const PolygonMesh& mesh);
/// Directed edges without an opposite, plus those that occur more than once.
std::size_t open_edges(const PolygonMesh& mesh);

}  // namespace sunder
