// Visual meshes: closed surfaces of general polygons, which may be non-convex and have holes and
// are triangulated only for rendering and export (paper 3.3, figure 9).
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
/// its inside is given by the even-odd rule. Caps, the faces made by cuts, come after all other
/// faces. Face f has the contours [first_contour, +contour_count), a contour the elements
/// [first_corner, +corner_count) of the corner arrays. All are in the order of faces and contours,
/// without gaps.
struct PolygonMesh {
  struct Contour {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
  };
  struct Face {
    Plane plane;
    PlaneId id;  ///< Id of the cutting plane on a cap, none on the original surface.
    std::uint32_t first_contour = 0;
    std::uint32_t contour_count = 0;
    FaceKind kind = FaceKind::kSurface;
    /// 1 + index of the face's appearance in the list of the file or scene that the mesh belongs to
    /// (RawMesh::groups, Scene::appearances), kept by all cuts; 0: that of the material.
    std::uint32_t appearance = 0;
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
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

/// Returns the index of the first cap, or the number of faces if there are no caps.
std::size_t first_cap(const PolygonMesh& mesh);
/// Returns the area of a face in m², without its holes.
double face_area(const PolygonMesh& mesh, std::size_t face);
/// Returns the surface of a convex as a mesh.
PolygonMesh polygon_mesh(const ConvexPolyhedron& convex);
/// Returns texture coordinates in m: the point projected along the largest component of `normal`.
Vec2f planar_uv(const Vec3& point, const Vec3& normal);
/// Returns the bounding box.
Box bounds(const PolygonMesh& mesh);
/// Returns mass properties for density 1 (divergence theorem); the mesh must be watertight.
MassProperties mass_properties(const PolygonMesh& mesh);
/// Returns the number of directed edges without an opposite or repeated; 0 if watertight.
std::size_t open_edges(const PolygonMesh& mesh);

}  // namespace sunder
