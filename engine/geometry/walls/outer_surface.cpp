#include "engine/geometry/walls/outer_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/geometry/close_points.h"
#include "engine/geometry/triangulate_face.h"
#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

/// Distances up to which points of two meshes are joined, over the largest coordinate, in the order
/// in which they are tried until the surface is closed.
constexpr double kTolerances[] = {4e-12, 4e-13, 4e-14, 4e-11, 4e-10};
/// Distance over the largest coordinate by which rounding errors separate points that are one.
constexpr double kRoundingTolerance = 4e-14;
/// Greatest relative error of the volume of a result.
constexpr double kMaxVolumeError = 1e-12;

std::optional<OuterSurface> merge_meshes(std::span<const PolygonMesh* const> meshes,
                                         double tolerance_m, bool cover_repeatedly) {
  PieceSurface surface = join_meshes(meshes, tolerance_m);
  const std::vector<WallPlane> planes = find_wall_planes(surface, tolerance_m);
  if (!split_edges(surface, planes, tolerance_m)) return std::nullopt;
  for (const WallPlane& plane : planes) {
    if (!remove_common(surface, plane, cover_repeatedly)) return std::nullopt;
  }
  if (!divide_touching_edges(surface)) return std::nullopt;
  return assemble(surface);
}

/// Removes pairs of triangles with the same corners and opposite orientation.
void cancel_opposite(std::vector<PieceSurface::Face>& triangles) {
  struct Corners {
    std::array<std::uint32_t, 3> points;  ///< Ascending.
    std::size_t triangle = 0;
    bool is_reversed = false;
  };
  std::vector<Corners> all;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const PieceSurface::Contour& contour = triangles[t].contours[0];
    std::array<std::uint32_t, 3> points = {contour[0].point, contour[1].point, contour[2].point};
    std::rotate(points.begin(), std::ranges::min_element(points), points.end());
    const bool is_reversed = points[1] > points[2];
    if (is_reversed) std::swap(points[1], points[2]);
    all.push_back({points, t, is_reversed});
  }
  std::ranges::stable_sort(all, {}, &Corners::points);
  std::vector<std::uint8_t> is_removed(triangles.size(), 0);
  std::vector<const Corners*> unmatched;  // of the same corners and orientation
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0 && all[i].points != all[i - 1].points) unmatched.clear();
    if (!unmatched.empty() && unmatched.back()->is_reversed != all[i].is_reversed) {
      is_removed[all[i].triangle] = is_removed[unmatched.back()->triangle] = 1;
      unmatched.pop_back();
    } else {
      unmatched.push_back(&all[i]);
    }
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_removed[t]) continue;
    if (kept != t) triangles[kept] = std::move(triangles[t]);
    ++kept;
  }
  triangles.resize(kept);
}

/// Returns the triangles of a surface on common points. Sets `is_changed` to true if points were
/// moved, or triangles left out because they have equal corners.
PieceSurface triangles_on_common_points(const OuterSurface& outer, bool& is_changed) {
  const PolygonMesh& mesh = outer.mesh;
  double reach = 0;
  for (const Vec3& v : mesh.vertices) reach = std::max(reach, v.cwiseAbs().maxCoeff());
  DisjointSets joined(mesh.vertices.size());
  each_close_pair(mesh.vertices, kRoundingTolerance * reach, [&](std::uint32_t a, std::uint32_t b) {
    joined.join(a, b);
    is_changed |= mesh.vertices[a] != mesh.vertices[b];
  });
  const std::vector<std::uint32_t> first_at = joined.roots();
  PieceSurface surface;
  surface.points = mesh.vertices;
  surface.has_uvs = !mesh.corner_uvs.empty();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const PolygonMesh::Face& face = mesh.faces[f];
    for (const Triangle& corners : triangulate(mesh, f)) {
      PieceSurface::Contour contour;
      for (const std::uint32_t c : corners) {
        const Vec2f uv = surface.has_uvs ? mesh.corner_uvs[c] : Vec2f(Vec2f::Zero());
        contour.push_back({first_at[mesh.corners[c]], mesh.corner_normals[c], uv});
      }
      clean_contour(contour);
      is_changed |= contour.empty();
      if (contour.empty()) continue;
      const Vec3& apex = surface.points[contour[0].point];
      const Vec3 area =
          (surface.points[contour[1].point] - apex).cross(surface.points[contour[2].point] - apex);
      // A face whose outline crosses itself has triangles that face the other way.
      const Plane plane = area.dot(face.plane.normal) < 0 ? face.plane.flipped() : face.plane;
      surface.faces.push_back(
          {plane, face.id, face.kind, face.appearance, outer.from[f], {contour}});
    }
  }
  return surface;
}

/// Replaces triangles that have points from `first_new` on in their edges by triangles that have
/// these as corners. No triangle has an edge from end to end of one that was divided.
void triangulate_divided(PieceSurface& surface, std::uint32_t first_new) {
  std::vector<PieceSurface::Face> triangles;
  for (PieceSurface::Face& face : surface.faces) {
    PieceSurface::Contour rest = std::move(face.contours[0]);
    const auto is_new = [&](std::size_t i) { return rest[i % rest.size()].point >= first_new; };
    const auto cut = [&](std::size_t tip) {
      const std::size_t n = rest.size();
      triangles.push_back(face);
      triangles.back().contours = {{rest[(tip + n - 1) % n], rest[tip], rest[(tip + 1) % n]}};
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(tip));
    };
    for (std::size_t i = 0; rest.size() > 3 && i < rest.size(); ++i) {
      if (!is_new(i) && is_new(i + 1) && is_new(i + rest.size() - 1)) cut(i);
    }
    std::size_t hub = 0;  // a new point, which is a corner of all the triangles that are left
    while (rest.size() > 3 && !is_new(hub)) ++hub;
    std::rotate(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(hub), rest.end());
    while (rest.size() >= 3) cut(1);
  }
  surface.faces = std::move(triangles);
}

/// Returns true if an edge has more than two faces.
bool has_non_manifold_edge(const PieceSurface& surface) {
  std::vector<PointPair> edges;
  for (const PieceSurface::Face& face : surface.faces) {
    for (const PieceSurface::Contour& contour : face.contours) {
      for (std::size_t i = 0; i < contour.size(); ++i)
        edges.push_back(
            point_pair(contour[i].point, contour[i + 1 < contour.size() ? i + 1 : 0].point));
    }
  }
  std::ranges::sort(edges);
  for (std::size_t i = 2; i < edges.size(); ++i) {
    if (edges[i] == edges[i - 2]) return true;
  }
  return false;
}

}  // namespace

std::optional<OuterSurface> outer_surface(std::span<const PolygonMesh* const> meshes) {
  if (meshes.size() == 1) {
    if (open_edges(*meshes[0]) > 0) return std::nullopt;
    return OuterSurface{*meshes[0], std::vector<std::uint32_t>(meshes[0]->faces.size(), 0)};
  }
  double volume_m3 = 0, reach = 0;
  for (const PolygonMesh* mesh : meshes) {
    volume_m3 += mass_properties(*mesh).volume_m3;
    for (const Vec3& v : mesh->vertices) reach = std::max(reach, v.cwiseAbs().maxCoeff());
  }
  for (const bool cover_repeatedly : {false, true}) {
    for (const double tolerance : kTolerances) {
      std::optional<OuterSurface> result =
          merge_meshes(meshes, tolerance * reach, cover_repeatedly);
      if (!result || open_edges(result->mesh) > 0) continue;
      const double error = mass_properties(result->mesh).volume_m3 - volume_m3;
      if (std::abs(error) <= kMaxVolumeError * std::abs(volume_m3)) return result;
    }
  }
  return std::nullopt;
}

void make_triangles_manifold(OuterSurface& outer) {
  constexpr int kMaxRounds = 4;  // divided triangles have new edges, which may coincide
  for (int round = 0; round < kMaxRounds; ++round) {
    bool is_changed = false;
    PieceSurface surface = triangles_on_common_points(outer, is_changed);
    if (!is_changed && !has_non_manifold_edge(surface)) return;
    cancel_opposite(surface.faces);
    const auto first_new = static_cast<std::uint32_t>(surface.points.size());
    if (surface.faces.empty() || !divide_touching_edges(surface)) return;
    triangulate_divided(surface, first_new);
    std::optional<OuterSurface> separated = assemble(surface);
    if (!separated) return;
    outer = std::move(*separated);
  }
}

OuterSurface concatenate_meshes(std::span<const PolygonMesh* const> meshes) {
  OuterSurface all;
  PolygonMesh& to = all.mesh;
  const bool has_uvs = std::ranges::any_of(
      meshes, [](const PolygonMesh* mesh) { return !mesh->corner_uvs.empty(); });
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    const PolygonMesh& mesh = *meshes[m];
    const auto vertex = static_cast<std::uint32_t>(to.vertices.size());
    const auto corner = static_cast<std::uint32_t>(to.corners.size());
    const auto contour = static_cast<std::uint32_t>(to.contours.size());
    to.vertices.insert(to.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const std::uint32_t v : mesh.corners) to.corners.push_back(vertex + v);
    to.corner_normals.insert(to.corner_normals.end(), mesh.corner_normals.begin(),
                             mesh.corner_normals.end());
    for (PolygonMesh::Contour one : mesh.contours) {
      one.first_corner += corner;
      to.contours.push_back(one);
    }
    for (PolygonMesh::Face face : mesh.faces) {
      for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
        for (const std::uint32_t v : mesh.contour_corners(k)) {
          if (!has_uvs || !mesh.corner_uvs.empty()) break;
          to.corner_uvs.push_back(planar_uv(mesh.vertices[v], face.plane.normal));
        }
      }
      face.first_contour += contour;
      to.faces.push_back(face);
      all.from.push_back(m);
    }
    to.corner_uvs.insert(to.corner_uvs.end(), mesh.corner_uvs.begin(), mesh.corner_uvs.end());
  }
  return all;
}

}  // namespace sunder
