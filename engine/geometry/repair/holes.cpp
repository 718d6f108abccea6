#include "engine/geometry/repair/holes.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/repair/clean.h"
#include "engine/geometry/triangulate.h"

namespace sunder {
namespace {

/// Loops with more corners than this are taken for missing parts of the mesh and stay open.
constexpr std::size_t kMaxLoopCorners = 2000;
/// Greatest distance of corners of a planar loop from its plane, over the length of the loop.
constexpr double kPlanarLoopTolerance = 1e-5;
/// Greatest area of a curved loop's patch over the shell's; a larger patch would lie on the shell.
constexpr double kMaxPatchAreaRatio = 0.9;

/// A loop of open edges, with vertices in the order of the polygon that would close it.
struct Loop {
  std::vector<std::uint32_t> vertices;
  std::uint32_t polygon;  ///< A polygon at the loop.
};

std::vector<Loop> open_loops(const Surface& surface) {
  std::vector<std::uint32_t> open_from(surface.mesh.vertices.size(), Surface::kNone);
  const std::vector<std::uint32_t> open = surface.open_half_edges();
  for (const std::uint32_t c : open) open_from[surface.mesh.corners[c]] = c;
  std::vector<Loop> loops;
  for (const std::uint32_t start : open) {
    Loop loop;
    loop.polygon = surface.polygon[start];
    for (std::uint32_t c = start; c != Surface::kNone;) {
      const std::uint32_t v = surface.mesh.corners[c];
      if (open_from[v] == Surface::kNone) break;  // already in a loop
      open_from[v] = Surface::kNone;
      loop.vertices.push_back(v);
      c = open_from[surface.mesh.corners[surface.next(c)]];
    }
    if (loop.vertices.empty()) continue;
    std::reverse(loop.vertices.begin(), loop.vertices.end());
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<Vec3> points_of(const Surface& surface, const Loop& loop) {
  std::vector<Vec3> points;
  for (const std::uint32_t v : loop.vertices) points.push_back(surface.mesh.vertices[v]);
  return points;
}

bool is_planar(const std::vector<Vec3>& points) {
  Vec3 normal = Vec3::Zero(), center = Vec3::Zero();
  double length = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& next = points[(i + 1) % points.size()];
    normal += (points[i] - points[0]).cross(next - points[0]);
    center += points[i] / static_cast<double>(points.size());
    length += (next - points[i]).norm();
  }
  if (!(normal.norm() > 1e-9 * length * length)) return false;
  normal.normalize();
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    return std::abs(normal.dot(p - center)) <= kPlanarLoopTolerance * length;
  });
}

double area_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  double area = 0;
  for (const Triangle& t : triangles) {
    area += 0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm();
  }
  return area;
}

/// Returns true if a planar contour does not cross itself: its triangles do not overlap.
bool is_simple(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < points.size(); ++i) {
    twice += (points[i - 1] - points[0]).cross(points[i] - points[0]);
  }
  return area_of(points, triangles) <= 0.5 * twice.norm() * (1 + 1e-6);
}

}  // namespace

ClosedHoles close_holes(Surface& surface) {
  ClosedHoles closed;
  const std::vector<Loop> loops = open_loops(surface);
  std::uint32_t shell_count = 0;
  const std::vector<std::uint32_t> shell = shells_of(surface, shell_count);
  std::vector<double> area(shell_count, 0);
  for (std::size_t p = 0; p < surface.mesh.polygons.size(); ++p) {
    area[shell[p]] += 0.5 * double_area(surface.mesh, p).norm();
  }
  for (const Loop& loop : loops) {
    const std::size_t n = loop.vertices.size();
    if (n < 3 || n > kMaxLoopCorners) continue;
    const std::vector<Vec3> points = points_of(surface, loop);
    const bool planar = is_planar(points);
    const std::vector<Triangle> triangles = triangulate(points);
    if (!planar && area_of(points, triangles) > kMaxPatchAreaRatio * area[shell[loop.polygon]])
      continue;
    ++(planar ? closed.planar : closed.curved);
    const std::uint32_t group = surface.mesh.polygons[loop.polygon].group;
    if (planar && is_simple(points, triangles)) {
      append_polygon(surface.mesh, loop.vertices, group);
      continue;
    }
    for (const Triangle& t : triangles) {
      append_polygon(surface.mesh,
                     std::array{loop.vertices[t[0]], loop.vertices[t[1]], loop.vertices[t[2]]},
                     group);
    }
  }
  return closed;
}

}  // namespace sunder
