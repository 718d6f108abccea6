// Read first: loft().
#include "scenes/structures/loft.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/roots.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/double_area.h"
#include "engine/geometry/hull.h"
#include "engine/geometry/repair/normals.h"
#include "engine/geometry/repair/surface.h"
#include "fracture/cut/surface.h"

namespace sunder::scenes {
namespace {

constexpr double kCircle = 2 * std::numbers::pi;
constexpr double kCreaseCosine = 0.766;  // cos 40°
/// A quadrangle is flat if its volume is at most this fraction of the cube of its size.
constexpr double kFlatnessTolerance = 1e-9;

using Corners = std::vector<std::uint32_t>;

void add_polygon(RawMesh& mesh, const Corners& corners) {
  mesh.polygons.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                           static_cast<std::uint32_t>(corners.size())});
  mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
}

bool is_flat(const RawMesh& mesh, const Corners& quad) {
  const Vec3 a = mesh.vertices[quad[0]];
  const Vec3 p = mesh.vertices[quad[1]] - a, q = mesh.vertices[quad[2]] - a,
             r = mesh.vertices[quad[3]] - a;
  const double size = q.norm() + (r - p).norm();
  return std::abs(p.cross(q).dot(r)) <= kFlatnessTolerance * size * size * size;
}

void add_side(RawMesh& mesh, const Corners& quad) {
  if (is_flat(mesh, quad)) return add_polygon(mesh, quad);
  add_polygon(mesh, {quad[0], quad[1], quad[2]});
  add_polygon(mesh, {quad[0], quad[2], quad[3]});
}

double volume_of(const RawMesh& mesh) {
  double six = 0;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const auto corners = mesh.polygon_corners(p);
    six += double_area(mesh.vertices, corners).dot(mesh.vertices[corners[0]]);
  }
  return six / 6;
}

/// Returns the polygons of the solid between rings, facing outward for either order of the rings.
RawMesh joined(std::span<const Ring> rings) {
  const auto around = static_cast<std::uint32_t>(rings[0].size());
  const auto last = static_cast<std::uint32_t>(rings.size() - 1) * around;
  RawMesh mesh;
  for (const Ring& ring : rings) {
    SUNDER_CHECK(ring.size() == around);
    mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  }
  Corners begin, end;
  for (std::uint32_t i = 0; i < around; ++i)
    begin.push_back(around - 1 - i), end.push_back(last + i);
  add_polygon(mesh, begin);
  add_polygon(mesh, end);
  for (std::uint32_t first = 0; first < last; first += around) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = first + i, b = first + (i + 1) % around;
      add_side(mesh, {a, b, b + around, a + around});
    }
  }
  if (volume_of(mesh) < 0) {
    for (const RawMesh::Polygon& polygon : mesh.polygons) {
      const auto corner = mesh.corners.begin() + polygon.first_corner;
      std::reverse(corner, corner + polygon.corner_count);
    }
  }
  return mesh;
}

}  // namespace

PolygonMesh loft(std::span<const Ring> rings) {
  SUNDER_CHECK(rings.size() >= 2);
  const Surface surface = pair_edges(joined(rings));
  const RawMesh& raw = surface.mesh;
  PolygonMesh mesh;
  mesh.vertices = raw.vertices;
  mesh.corners = raw.corners;
  mesh.corner_normals = shading_normals(surface, kCreaseCosine);
  for (std::uint32_t p = 0; p < raw.polygons.size(); ++p) {
    const auto corners = raw.polygon_corners(p);
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : corners) middle += raw.vertices[v];
    middle /= static_cast<double>(corners.size());
    const Vec3 normal = double_area(raw.vertices, corners).normalized();
    mesh.faces.push_back({Plane::through(middle, normal), {}, p, 1});
    mesh.contours.push_back({raw.polygons[p].first_corner, raw.polygons[p].corner_count});
  }
  return mesh;
}

Profile& Profile::to(double x, double y) {
  points_.emplace_back(x, y);
  return *this;
}

Profile& Profile::curve(const Vec2& control, double x, double y, int segments) {
  const Vec2 from = points_.back(), end(x, y);
  for (int i = 1; i < segments; ++i) {
    const double t = i / static_cast<double>(segments), s = 1 - t;
    points_.push_back(s * s * from + 2 * s * t * control + t * t * end);
  }
  return to(x, y);
}

std::vector<Ring> turned(std::span<const Vec2> outline, std::span<const Vec2> profile) {
  std::vector<Ring> rings;
  for (const Vec2& level : profile) {
    Ring& ring = rings.emplace_back();
    for (const Vec2& p : outline)
      ring.emplace_back(level.x() * p.x(), level.y(), level.x() * p.y());
  }
  return rings;
}

std::vector<Vec2> circle(int segments) {
  std::vector<Vec2> outline;
  for (int i = 0; i < segments; ++i) {
    const SinCos turn = sin_cos(kCircle * i / segments);
    outline.emplace_back(turn.sin, turn.cos);
  }
  return outline;
}

std::vector<Vec2> fluted(int flutes, int segments, double depth) {
  constexpr double kFillet = 0.15;  // width of the ridge between two flutes, of their pitch
  std::vector<Vec2> outline;
  for (int i = 0; i < flutes; ++i) {
    for (int k = 0; k <= segments; ++k) {
      const double t = k / static_cast<double>(segments);
      const double radius = 1 - 4 * depth * t * (1 - t);
      const SinCos turn = sin_cos(kCircle * (i + (1 - kFillet) * t) / flutes);
      outline.emplace_back(radius * turn.sin, radius * turn.cos);
    }
  }
  return outline;
}

ConvexPolyhedron prism_around(std::span<const Ring> rings, int sides) {
  double radius = 0;
  for (const Ring& ring : rings) {
    for (const Vec3& p : ring) radius = std::max(radius, hypotenuse(p.x(), p.z()));
  }
  radius /= sin_cos(kCircle / (2 * sides)).cos;
  std::vector<Vec2> plan;
  for (int i = 0; i < sides; ++i) {
    const SinCos turn = sin_cos(kCircle * (i + 0.5) / sides);
    plan.emplace_back(radius * turn.sin, radius * turn.cos);
  }
  return block(plan, rings.front()[0].y(), rings.back()[0].y());
}

ConvexPolyhedron block(std::span<const Vec2> plan_xz, double bottom, double top) {
  std::vector<Vec3> points;
  for (const double y : {bottom, top}) {
    for (const Vec2& p : plan_xz) points.emplace_back(p.x(), y, p.y());
  }
  return make_hull(points);
}

Part lofted(std::span<const Ring> rings, const ConvexPolyhedron& region, MaterialIndex material) {
  auto mesh = std::make_shared<PolygonMesh>(loft(rings));
  Part part{fracture::fit_to_points(region, mesh->vertices, Fit()), material};
  part.visual = std::move(mesh);
  return part;
}

}  // namespace sunder::scenes
