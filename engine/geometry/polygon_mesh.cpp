#include "engine/geometry/polygon_mesh.h"

#include <algorithm>
#include <utility>

#include "engine/base/state_checks.h"
#include "engine/geometry/moments.h"

namespace sunder {

const char* PolygonMesh::wrong_field() const {
  std::size_t contour = 0, corner = 0;
  for (const Face& face : faces) {
    if (face.first_contour != contour || face.contour_count > contours.size() - contour)
      return "faces";
    contour += face.contour_count;
  }
  if (contour != contours.size()) return "contours";
  for (const Contour& one : contours) {
    if (one.first_corner != corner || one.corner_count > corners.size() - corner) return "contours";
    corner += one.corner_count;
  }
  if (corner != corners.size() || !all_below(corners, vertices.size())) return "corners";
  if (corner_normals.size() != corners.size()) return "corner_normals";
  return corner_uvs.empty() || corner_uvs.size() == corners.size() ? nullptr : "corner_uvs";
}

std::size_t first_cap(const PolygonMesh& mesh) {
  std::size_t first = mesh.faces.size();
  while (first > 0 && !mesh.faces[first - 1].id.none()) --first;
  return first;
}

double face_area(const PolygonMesh& mesh, std::size_t face) {
  const PolygonMesh::Face& of = mesh.faces[face];
  Vec3 twice = Vec3::Zero();
  for (std::uint32_t k = of.first_contour; k < of.first_contour + of.contour_count; ++k) {
    const auto corners = mesh.contour_corners(k);
    const Vec3& apex = mesh.vertices[corners[0]];
    for (std::size_t i = 2; i < corners.size(); ++i) {
      twice += (mesh.vertices[corners[i - 1]] - apex).cross(mesh.vertices[corners[i]] - apex);
    }
  }
  return 0.5 * twice.norm();
}

PolygonMesh polygon_mesh(const ConvexPolyhedron& convex) {
  PolygonMesh mesh;
  mesh.vertices = convex.vertices;
  mesh.corners = convex.corners;
  mesh.corner_normals = convex.corner_normals;
  for (const ConvexPolyhedron::Face& face : convex.faces) {
    const auto contour = static_cast<std::uint32_t>(mesh.contours.size());
    mesh.contours.push_back({face.first_corner, face.corner_count});
    mesh.faces.push_back({face.plane, face.id, contour, 1, face.kind});
  }
  return mesh;
}

Vec2f planar_uv(const Vec3& point, const Vec3& normal) {
  int steepest = 0;
  normal.cwiseAbs().maxCoeff(&steepest);
  const Vec3f p = point.cast<float>();
  return {p[(steepest + 1) % 3], p[(steepest + 2) % 3]};
}

Box bounds(const PolygonMesh& mesh) {
  Box box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box;
}

MassProperties mass_properties(const PolygonMesh& mesh) {
  if (mesh.empty()) return {};
  const Vec3 origin = mesh.vertices[mesh.corners[0]];
  Moments moments(origin);
  // Holes run clockwise, so their fans contribute with a negative sign.
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    const Vec3 a = mesh.vertices[corners[0]] - origin;
    Vec3 c = mesh.vertices[corners[1]] - origin;
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 b = c;
      c = mesh.vertices[corners[i]] - origin;
      moments.add(a, b, c);
    }
  }
  return moments.sum();
}

std::size_t open_edges(const PolygonMesh& mesh) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> edges;
  edges.reserve(mesh.corners.size());
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      edges.emplace_back(corners[i], corners[i + 1 < corners.size() ? i + 1 : 0]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const bool repeated = e > 0 && edges[e] == edges[e - 1];
    const Edge opposite(edges[e].second, edges[e].first);
    open += repeated || !std::binary_search(edges.begin(), edges.end(), opposite);
  }
  return open;
}

}  // namespace sunder
