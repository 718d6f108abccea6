// Repeated cuts of a mesh with polygonal faces and with triangulated faces, as in the paper's
// figure 9. Only benchmarks and tests cut triangulated meshes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/random.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/triangulate_face.h"

namespace sunder::bench {

/// Returns the mesh with every face triangulated.
inline PolygonMesh triangulated(const PolygonMesh& mesh) {
  PolygonMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Triangle& triangle : triangulate(mesh, f)) {
      PolygonMesh::Face face = mesh.faces[f];
      face.first_contour = static_cast<std::uint32_t>(result.contours.size());
      face.contour_count = 1;
      result.faces.push_back(face);
      result.contours.push_back({static_cast<std::uint32_t>(result.corners.size()), 3});
      for (const std::uint32_t corner : triangle) {
        result.corners.push_back(mesh.corners[corner]);
        result.corner_normals.push_back(mesh.corner_normals[corner]);
      }
    }
  }
  return result;
}

/// Cuts all pieces by a plane. If `in_triangles`, triangulates the faces of the parts.
inline std::vector<PolygonMesh> cut_all(const std::vector<PolygonMesh>& pieces, const Plane& plane,
                                        PlaneId id, bool in_triangles) {
  std::vector<PolygonMesh> result;
  MeshClipScratch scratch;
  for (const PolygonMesh& piece : pieces) {
    for (const auto& [side, name] : {std::pair{plane, id}, {plane.flipped(), id.opposite()}}) {
      PolygonMesh part;
      const PlaneSide where = clip(piece, side, name, 0, part, scratch);
      if (where == PlaneSide::kInside) part = piece;
      if (where != PlaneSide::kOutside) {
        result.push_back(in_triangles ? triangulated(part) : std::move(part));
      }
    }
  }
  return result;
}

/// Returns planes in random directions through points near the centre of a box.
inline std::vector<Plane> planes_through(const Box& box, std::size_t count) {
  Random random(9);
  std::vector<Plane> planes;
  while (planes.size() < count) {
    const Vec3 aside(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2),
                     random.uniform(-0.2, 0.2));
    planes.push_back(
        Plane::through(box.center() + aside.cwiseProduct(box.extent()), random.direction()));
  }
  return planes;
}

inline std::size_t face_count(const std::vector<PolygonMesh>& pieces) {
  std::size_t count = 0;
  for (const PolygonMesh& piece : pieces) count += piece.faces.size();
  return count;
}

inline double volume_m3(const std::vector<PolygonMesh>& pieces) {
  double volume = 0;
  for (const PolygonMesh& piece : pieces) volume += mass_properties(piece).volume_m3;
  return volume;
}

/// Number of ill-shaped triangles of the faces: less than a hundredth as high as their longest
/// side.
inline std::size_t ill_shaped(const std::vector<PolygonMesh>& pieces) {
  constexpr double kMaxFlatness = 0.01;
  std::size_t count = 0;
  for (const PolygonMesh& piece : pieces) {
    for (std::size_t f = 0; f < piece.faces.size(); ++f) {
      for (const Triangle& t : triangulate(piece, f)) {
        const auto at = [&](std::size_t k) { return piece.vertices[piece.corners[t[k]]]; };
        const Vec3 a = at(1) - at(0), b = at(2) - at(1), c = at(0) - at(2);
        const double longest = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
        count += a.cross(b).norm() < kMaxFlatness * longest;
      }
    }
  }
  return count;
}

}  // namespace sunder::bench
