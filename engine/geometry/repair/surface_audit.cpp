#include "engine/geometry/repair/surface_audit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/surface.h"
#include "engine/geometry/repair/winding.h"
#include "engine/geometry/triangulate_face.h"

namespace sunder {
namespace {

/// Relative error of a coordinate, by which a flat island may have volume of either sign.
constexpr double kRounding = 4e-15;

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Corners = std::array<Vec3, 3>;

Corners corners_of(const RawMesh& mesh, std::size_t triangle) {
  const auto of = mesh.polygon_corners(triangle);
  return {mesh.vertices[of[0]], mesh.vertices[of[1]], mesh.vertices[of[2]]};
}

/// Removes triangles with equal corners; returns their number.
std::size_t drop_collapsed(RawMesh& mesh) {
  const std::size_t before = mesh.polygons.size();
  rewrite_polygons(mesh, [&](std::size_t, std::vector<std::uint32_t>& corners) {
    const std::uint32_t a = mesh.corners[corners[0]], b = mesh.corners[corners[1]],
                        c = mesh.corners[corners[2]];
    if (a == b || b == c || c == a) corners.clear();
  });
  return before - mesh.polygons.size();
}

/// Returns the directed edges of all triangles, sorted.
std::vector<Edge> directed_edges(const RawMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.corners.size());
  for (std::size_t t = 0; t < mesh.polygons.size(); ++t) {
    const auto of = mesh.polygon_corners(t);
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(of[i], of[(i + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

void count_edges(const std::vector<Edge>& edges, SurfaceAudit& audit) {
  for (auto it = edges.begin(); it != edges.end();) {
    const auto end = std::upper_bound(it, edges.end(), *it);
    const auto [first, last] =
        std::equal_range(edges.begin(), edges.end(), Edge(it->second, it->first));
    const auto forward = end - it, backward = last - first;
    const bool is_counted = backward > 0 && it->first > it->second;
    it = end;
    if (is_counted) continue;
    if (forward != backward) ++audit.open_edges;
    if (forward + backward > 2) ++audit.non_manifold_edges;
  }
}

/// Returns the distance along a ray at which it meets a triangle; infinity if it does not.
double distance_to(const Corners& triangle, const Vec3& from, const Vec3& direction) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Vec3 a = triangle[0] - from, b = triangle[1] - from, c = triangle[2] - from;
  const double u = direction.dot(b.cross(c)), v = direction.dot(c.cross(a)),
               w = direction.dot(a.cross(b));
  if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0)
    return kNever;
  const Vec3 normal = (b - a).cross(c - a);
  const double distance = normal.dot(a) / normal.dot(direction);
  return distance > 0 ? distance : kNever;
}

/// Returns a point between the largest triangle of an island and what is before its front: inside
/// an island of negative volume that does not pass through itself.
Vec3 point_before(const RawMesh& mesh, const std::vector<std::uint32_t>& island) {
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    return double_area(mesh, a).squaredNorm() < double_area(mesh, b).squaredNorm();
  };
  const std::uint32_t largest = *std::max_element(island.begin(), island.end(), less);
  const Corners corners = corners_of(mesh, largest);
  const Vec3 from = (corners[0] + corners[1] + corners[2]) / 3;
  const Vec3 direction = double_area(mesh, largest).normalized();
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : island) {
    if (t != largest)
      nearest = std::min(nearest, distance_to(corners_of(mesh, t), from, direction));
  }
  return std::isfinite(nearest) ? Vec3(from + 0.5 * nearest * direction) : from;
}

void count_islands(RawMesh mesh, SurfaceAudit& audit) {
  const Surface surface = pair_edges(std::move(mesh));
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> island = shells_of(surface, count);
  const std::vector<double> volume = volumes(surface.mesh, island, count);
  audit.islands = count;
  audit.volume_m3 = std::accumulate(volume.begin(), volume.end(), 0.0);
  if (std::none_of(volume.begin(), volume.end(), [](double of) { return of < 0; })) return;

  std::vector<std::vector<std::uint32_t>> members(count);
  std::vector<Corners> triangles;
  for (std::uint32_t t = 0; t < island.size(); ++t) {
    members[island[t]].push_back(t);
    triangles.push_back(corners_of(surface.mesh, t));
  }
  const WindingField field(triangles);
  for (std::uint32_t i = 0; i < count; ++i) {
    double area = 0, reach = 0;
    for (const std::uint32_t t : members[i]) {
      area += 0.5 * double_area(surface.mesh, t).norm();
      for (const Vec3& corner : triangles[t]) reach = std::max(reach, corner.cwiseAbs().maxCoeff());
    }
    if (volume[i] >= -kRounding * reach * area) continue;
    if (field.at(point_before(surface.mesh, members[i])) > -0.5) continue;
    ++audit.inside_out_islands;
    audit.inside_out_m3 -= volume[i];
  }
}

}  // namespace

SurfaceAudit& SurfaceAudit::operator+=(const SurfaceAudit& other) {
  triangles += other.triangles;
  collapsed_triangles += other.collapsed_triangles;
  open_edges += other.open_edges;
  non_manifold_edges += other.non_manifold_edges;
  twin_points += other.twin_points;
  islands += other.islands;
  inside_out_islands += other.inside_out_islands;
  inside_out_m3 += other.inside_out_m3;
  volume_m3 += other.volume_m3;
  return *this;
}

SurfaceAudit audit_surface(RawMesh mesh) {
  SurfaceAudit audit;
  join_identical(mesh);
  audit.collapsed_triangles = drop_collapsed(mesh);
  audit.triangles = mesh.polygons.size();
  const std::vector<Edge> edges = directed_edges(mesh);
  count_edges(edges, audit);
  audit.twin_points = find_twins(mesh, kTwinDistance_m).size();
  count_islands(std::move(mesh), audit);
  return audit;
}

RawMesh triangle_mesh(const PolygonMesh& mesh) {
  RawMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Triangle& corners : triangulate(mesh, f)) {
      result.polygons.push_back({static_cast<std::uint32_t>(result.corners.size()), 3});
      for (const std::uint32_t corner : corners) result.corners.push_back(mesh.corners[corner]);
    }
  }
  return result;
}

}  // namespace sunder
