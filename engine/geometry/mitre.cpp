#include "engine/geometry/mitre.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/base/check.h"
#include "engine/geometry/double_area.h"

namespace sunder {
namespace {

/// Returns the largest signed distance of a convex's vertices to a plane.
double reach_beyond(const ConvexPolyhedron& convex, const Plane& plane) {
  double farthest = std::numeric_limits<double>::lowest();
  for (const Vec3& v : convex.vertices) farthest = std::max(farthest, plane.distance(v));
  return farthest;
}

/// Returns true if two faces have the same plane: rounding may have split a face of one plane.
bool in_one_plane(const ConvexPolyhedron::Face& a, const ConvexPolyhedron::Face& b) {
  return a.plane.normal == b.plane.normal && a.plane.d == b.plane.d;
}

/// Returns the depth inside a plane of the deepest corner of a cell's front.
double depth_within(const ColumnCell& cell, const Plane& plane) {
  const auto& faces = cell.convex->faces;
  double deepest = std::numeric_limits<double>::lowest();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!in_one_plane(faces[f], faces[cell.front])) continue;
    for (const std::uint32_t v : cell.convex->face_corners(f)) {
      deepest = std::max(deepest, -plane.distance(cell.convex->vertices[v]));
    }
  }
  return deepest;
}

/// Copies id, kind and nearest shading normals to a face that was made from an old face's plane.
void copy_attributes(const ConvexPolyhedron& from, std::size_t from_face, ConvexPolyhedron& to,
                     ConvexPolyhedron::Face& face) {
  const ConvexPolyhedron::Face& old = from.faces[from_face];
  face.id = old.id;
  face.kind = old.kind;
  for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
    const Vec3& here = to.vertices[to.corners[c]];
    double least = std::numeric_limits<double>::max();
    for (std::uint32_t k = old.first_corner; k < old.first_corner + old.corner_count; ++k) {
      const double squared_distance = (from.vertices[from.corners[k]] - here).squaredNorm();
      if (squared_distance >= least) continue;
      least = squared_distance;
      to.corner_normals[c] = from.corner_normals[k];
    }
  }
}

/// Sets scratch.extended to the part of `box` inside all planes of a cell except that of its front.
/// Returns false if nothing is left, as for a cell no larger than the tolerance.
bool extend_cell(const ColumnCell& cell, const Box& box, double tolerance_m,
                 MitreScratch& scratch) {
  const ConvexPolyhedron& convex = *cell.convex;
  ConvexPolyhedron& extended = scratch.extended;
  extended = make_box(box.min, box.max);
  for (std::size_t f = 0; f < convex.faces.size(); ++f) {
    const auto is_same = [&](const ConvexPolyhedron::Face& other) {
      return in_one_plane(other, convex.faces[f]);
    };
    const auto here = convex.faces.begin() + static_cast<std::ptrdiff_t>(f);
    if (is_same(convex.faces[cell.front]) || std::any_of(convex.faces.begin(), here, is_same)) {
      continue;
    }
    const PlaneId number{2 * f + 2};  // provisional; faces of the box have none
    const Plane& plane = convex.faces[f].plane;
    const PlaneSide side = clip(extended, plane, number, tolerance_m, scratch.cut, scratch.clip);
    if (side == PlaneSide::kOutside) return false;
    if (side == PlaneSide::kCut) std::swap(extended, scratch.cut);
  }
  for (ConvexPolyhedron::Face& face : extended.faces) {
    if (!face.id.none()) copy_attributes(convex, face.id.value / 2 - 1, extended, face);
  }
  return true;
}

bool lies_within(const ConvexPolyhedron& convex, const Box& box) {
  return std::all_of(convex.vertices.begin(), convex.vertices.end(), [&](const Vec3& v) {
    return (v.array() > box.min.array()).all() && (v.array() < box.max.array()).all();
  });
}

/// Returns a box that edges up to 75° from the plane's normal leave only beyond the plane.
Box extension_bounds(const ConvexPolyhedron& convex, double depth) {
  Box box = bounds(convex);
  const double rounding = 1e-9 * box.max.cwiseMax(-box.min).norm();
  const double margin = std::max(depth, 0.0) / kMinMitreCosine + box.extent().norm() + rounding;
  box.min.array() -= margin;
  box.max.array() += margin;
  return box;
}

/// Extends or clips one cell. Returns kInside, with `result` unspecified, if the cell stays whole.
PlaneSide end_cell(const ColumnCell& cell, const Plane& midplane, PlaneId id, double tolerance_m,
                   ConvexPolyhedron& result, MitreScratch& scratch) {
  const Box limits = extension_bounds(*cell.convex, depth_within(cell, midplane));
  if (extend_cell(cell, limits, tolerance_m, scratch)) {
    const PlaneSide side = clip(scratch.extended, midplane, id, tolerance_m, result, scratch.clip);
    if (side == PlaneSide::kOutside) return side;
    if (side == PlaneSide::kInside) std::swap(result, scratch.extended);
    if (lies_within(result, limits)) return PlaneSide::kCut;
  }
  return clip(*cell.convex, midplane, id, tolerance_m, result, scratch.clip);
}

/// A copy of a mesh whose caps with one id are extruded.
class ExtrudedMesh {
 public:
  ExtrudedMesh(const PolygonMesh& mesh, PlaneId front, const Vec3& by)
      : old_(mesh), front_(front), by_(by), moved_(mesh.vertices.size(), kUnmoved) {
    mesh_.vertices = mesh.vertices;
    const std::size_t caps = first_cap(mesh);
    for (std::size_t f = 0; f < caps; ++f) add_copy(mesh.faces[f]);
    for (std::size_t f = caps; f < mesh.faces.size(); ++f) {
      if (mesh.faces[f].id == front) add_walls(mesh.faces[f]);
    }
    for (std::size_t f = caps; f < mesh.faces.size(); ++f) add_copy(mesh.faces[f]);
  }
  const PolygonMesh& mesh() const { return mesh_; }

 private:
  static constexpr std::uint32_t kUnmoved = std::numeric_limits<std::uint32_t>::max();

  void add_copy(const PolygonMesh::Face& face) {
    const auto first = static_cast<std::uint32_t>(mesh_.contours.size());
    for (std::uint32_t k = 0; k < face.contour_count; ++k) {
      const PolygonMesh::Contour& contour = old_.contours[face.first_contour + k];
      const auto corner = static_cast<std::uint32_t>(mesh_.corners.size());
      mesh_.contours.push_back({corner, contour.corner_count});
      for (std::uint32_t c = contour.first_corner; c < contour.first_corner + contour.corner_count;
           ++c) {
        const std::uint32_t v = old_.corners[c];
        mesh_.corners.push_back(face.id == front_ ? moved(v) : v);
        mesh_.corner_normals.push_back(old_.corner_normals[c]);
        if (!old_.corner_uvs.empty()) mesh_.corner_uvs.push_back(old_.corner_uvs[c]);
      }
    }
    mesh_.faces.push_back(
        {face.plane, face.id, first, face.contour_count, face.kind, face.appearance});
  }

  void add_walls(const PolygonMesh::Face& cap) {
    for (std::uint32_t k = 0; k < cap.contour_count; ++k) {
      const auto corners = old_.contour_corners(cap.first_contour + k);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        add_wall(corners[i], corners[(i + 1) % corners.size()]);
      }
    }
  }

  void add_wall(std::uint32_t from, std::uint32_t to) {
    const std::array quad = {from, to, moved(to), moved(from)};
    const Vec3 area = double_area(mesh_.vertices, quad);
    const Vec3 normal = area.norm() > 0 ? area.normalized() : by_.unitOrthogonal();
    const auto contour = static_cast<std::uint32_t>(mesh_.contours.size());
    mesh_.contours.push_back({static_cast<std::uint32_t>(mesh_.corners.size()), 4});
    for (const std::uint32_t v : quad) {
      mesh_.corners.push_back(v);
      mesh_.corner_normals.push_back(normal.cast<float>());
      if (!old_.corner_uvs.empty()) {
        mesh_.corner_uvs.push_back(planar_uv(mesh_.vertices[v], normal));
      }
    }
    mesh_.faces.push_back({Plane::through(mesh_.vertices[from], normal), {}, contour, 1});
  }

  std::uint32_t moved(std::uint32_t vertex) {
    if (moved_[vertex] == kUnmoved) {
      moved_[vertex] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(old_.vertices[vertex] + by_);
    }
    return moved_[vertex];
  }

  const PolygonMesh& old_;
  const PlaneId front_;
  const Vec3 by_;
  std::vector<std::uint32_t> moved_;  ///< Number of the moved copy of each old vertex.
  PolygonMesh mesh_;
};

/// Returns the depth inside a plane of the deepest corner of the caps with the id `front`.
double depth_within(const PolygonMesh& mesh, PlaneId front, const Plane& plane) {
  double deepest = std::numeric_limits<double>::lowest();
  for (std::size_t f = first_cap(mesh); f < mesh.faces.size(); ++f) {
    const PolygonMesh::Face& face = mesh.faces[f];
    if (face.id != front) continue;
    for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
      for (const std::uint32_t v : mesh.contour_corners(k)) {
        deepest = std::max(deepest, -plane.distance(mesh.vertices[v]));
      }
    }
  }
  return deepest;
}

}  // namespace

std::optional<Midplane> midplane(const SectionEnd& a, const SectionEnd& b, const Pose& X_AB) {
  const Vec3 twice = a.along - X_AB.rotation * b.along;
  if (twice.norm() < 2 * kMinMitreCosine) return std::nullopt;
  const Vec3 normal = twice.normalized();
  const Vec3 point = 0.5 * (a.centroid + X_AB * b.centroid);
  const Pose X_BA = X_AB.inverse();
  return Midplane{Plane::through(point, normal),
                  Plane::through(X_BA * point, X_BA.rotation * -normal)};
}

std::optional<std::size_t> mitre(std::span<const ColumnCell> column, const Plane& midplane,
                                 PlaneId id, double tolerance_m, ConvexPolyhedron& result,
                                 MitreScratch& scratch) {
  SUNDER_CHECK(!column.empty());
  std::size_t last = column.size() - 1;
  while (last > 0 && reach_beyond(*column[last].convex, midplane) <= tolerance_m) --last;
  const PlaneSide side = end_cell(column[last], midplane, id, tolerance_m, result, scratch);
  if (side == PlaneSide::kOutside) return std::nullopt;
  if (side == PlaneSide::kInside) result = *column[last].convex;
  return last;
}

PlaneSide mitre(const PolygonMesh& mesh, PlaneId front, const Vec3& along, const Plane& midplane,
                PlaneId id, double tolerance_m, PolygonMesh& result, MeshClipScratch& scratch) {
  const double cosine = along.dot(midplane.normal);
  SUNDER_CHECK(cosine > 0);
  const double depth = depth_within(mesh, front, midplane);
  const double margin = bounds(mesh).extent().norm();  // all of the moved caps are cut off
  const Vec3 by = (std::max(depth, 0.0) + margin) / cosine * along;
  return clip(ExtrudedMesh(mesh, front, by).mesh(), midplane, id, tolerance_m, result, scratch);
}

}  // namespace sunder
