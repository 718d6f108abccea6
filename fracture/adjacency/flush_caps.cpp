// Read first: with_flush_caps(). Edges that two joined faces share are inside the cap.
#include "fracture/adjacency/flush_caps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace sunder::fracture {
namespace {

constexpr double kSameNormal = 1e-6;  // Distance of two equal unit normals.
constexpr std::uint32_t kNotFlush = 0xffffffff;

using OutlineEdge = std::pair<std::uint32_t, std::uint32_t>;  // From vertex to vertex.

bool lies_in(const PolygonMesh& mesh, const PolygonMesh::Face& face, const Plane& plane,
             double tolerance_m) {
  if ((face.plane.normal - plane.normal).squaredNorm() > kSameNormal * kSameNormal) return false;
  for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
    for (const std::uint32_t v : mesh.contour_corners(k)) {
      if (std::abs(plane.distance(mesh.vertices[v])) > tolerance_m) return false;
    }
  }
  return true;
}

/// Mesh under construction: copies of another mesh's faces, some of them joined.
class CappedMesh {
 public:
  explicit CappedMesh(const PolygonMesh& old) : old_(old) { mesh_.vertices = old.vertices; }

  void add_copy(const PolygonMesh::Face& face) {
    begin(face.plane, face.id, face.kind);
    mesh_.faces.back().appearance = face.appearance;
    for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
      const PolygonMesh::Contour& contour = old_.contours[k];
      for (std::uint32_t i = 0; i < contour.corner_count; ++i) add_corner(contour.first_corner + i);
      end_contour(contour.corner_count);
    }
  }

  /// Adds one cap with the common outline of some faces, contour by contour.
  void add_joined(std::span<const PolygonMesh::Face> faces, const ConvexPolyhedron::Face& in) {
    begin(in.plane, in.id, FaceKind::kInterior);
    std::map<OutlineEdge, std::uint32_t> corner_of;  // Corner at the start of an edge.
    for (const PolygonMesh::Face& face : faces) {
      if (face.kind == FaceKind::kSurface) mesh_.faces.back().kind = face.kind;
      if (face.appearance != 0) mesh_.faces.back().appearance = face.appearance;
      add_edges(face, corner_of);
    }
    while (!corner_of.empty()) {
      const std::uint32_t start = corner_of.begin()->first.first;
      std::uint32_t count = 0;
      for (std::uint32_t at = start; count == 0 || at != start; ++count) {
        const auto edge = corner_of.lower_bound({at, 0});
        if (edge == corner_of.end() || edge->first.first != at)
          break;  // The mesh is not watertight.
        add_corner(edge->second);
        at = edge->first.second;
        corner_of.erase(edge);
      }
      end_contour(count);
    }
  }

  PolygonMesh take() { return std::move(mesh_); }

 private:
  void begin(const Plane& plane, PlaneId id, FaceKind kind) {
    mesh_.faces.push_back({plane, id, static_cast<std::uint32_t>(mesh_.contours.size()), 0, kind});
  }

  void add_corner(std::uint32_t corner) {
    mesh_.corners.push_back(old_.corners[corner]);
    mesh_.corner_normals.push_back(old_.corner_normals[corner]);
    if (!old_.corner_uvs.empty()) mesh_.corner_uvs.push_back(old_.corner_uvs[corner]);
  }

  void end_contour(std::uint32_t corners) {
    mesh_.contours.push_back({static_cast<std::uint32_t>(mesh_.corners.size()) - corners, corners});
    ++mesh_.faces.back().contour_count;
  }

  /// Adds the edges of a face, and removes those of earlier faces in the opposite direction.
  void add_edges(const PolygonMesh::Face& face,
                 std::map<OutlineEdge, std::uint32_t>& corner_of) const {
    for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
      const PolygonMesh::Contour& contour = old_.contours[k];
      for (std::uint32_t i = 0; i < contour.corner_count; ++i) {
        const std::uint32_t corner = contour.first_corner + i;
        const std::uint32_t after = contour.first_corner + (i + 1) % contour.corner_count;
        const OutlineEdge edge{old_.corners[corner], old_.corners[after]};
        if (corner_of.erase({edge.second, edge.first}) == 0) corner_of.emplace(edge, corner);
      }
    }
  }

  const PolygonMesh& old_;
  PolygonMesh mesh_;
};

/// Returns, per face of a mesh, the face of `flush_faces` in whose plane it lies, or kNotFlush.
/// Caps count only in planes that have surface too.
std::vector<std::uint32_t> find_flush(const PolygonMesh& visual, const ConvexPolyhedron& polyhedron,
                                      std::span<const std::uint32_t> flush_faces,
                                      double tolerance_m) {
  std::vector<std::uint32_t> flush_with(visual.faces.size(), kNotFlush);
  for (const std::uint32_t f : flush_faces) {
    const ConvexPolyhedron::Face& in = polyhedron.faces[f];
    bool any = false;
    const std::size_t caps = first_cap(visual);
    for (std::size_t i = 0; i < caps; ++i) {
      if (!lies_in(visual, visual.faces[i], in.plane, tolerance_m)) continue;
      flush_with[i] = f;
      any = true;
    }
    for (std::size_t i = caps; any && i < visual.faces.size(); ++i) {
      if (visual.faces[i].id == in.id) flush_with[i] = f;
    }
  }
  return flush_with;
}

}  // namespace

std::shared_ptr<const PolygonMesh> with_flush_caps(std::shared_ptr<const PolygonMesh> visual,
                                                   const ConvexPolyhedron& polyhedron,
                                                   std::span<const std::uint32_t> flush_faces,
                                                   double tolerance_m) {
  const std::vector<std::uint32_t> flush_with =
      find_flush(*visual, polyhedron, flush_faces, tolerance_m);
  const auto is_apart = [](std::uint32_t f) { return f == kNotFlush; };
  if (std::all_of(flush_with.begin(), flush_with.end(), is_apart)) return visual;
  CappedMesh capped(*visual);
  for (std::size_t i = 0; i < visual->faces.size(); ++i) {
    if (is_apart(flush_with[i])) capped.add_copy(visual->faces[i]);
  }
  std::vector<PolygonMesh::Face> joined;
  for (const std::uint32_t f : flush_faces) {
    joined.clear();
    for (std::size_t i = 0; i < visual->faces.size(); ++i) {
      if (flush_with[i] == f) joined.push_back(visual->faces[i]);
    }
    if (!joined.empty()) capped.add_joined(joined, polyhedron.faces[f]);
  }
  return std::make_shared<PolygonMesh>(capped.take());
}

}  // namespace sunder::fracture
