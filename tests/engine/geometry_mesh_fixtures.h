// Meshes that are not convex, for tests: concave faces, holes, tunnels, several shells.
#pragma once

#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "tests/engine/geometry_fixtures.h"

namespace sunder::test {

inline void add_polygon(PolygonMesh& mesh, std::vector<std::vector<std::uint32_t>> contours) {
  PolygonMesh::Face& face = mesh.faces.emplace_back();
  face.first_contour = static_cast<std::uint32_t>(mesh.contours.size());
  face.contour_count = static_cast<std::uint32_t>(contours.size());
  Vec3 normal = Vec3::Zero();
  for (const auto& corners : contours) {
    mesh.contours.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                             static_cast<std::uint32_t>(corners.size())});
    for (std::size_t i = 0; i < corners.size(); ++i) {
      normal += mesh.vertices[corners[i]].cross(mesh.vertices[corners[(i + 1) % corners.size()]]);
      mesh.corners.push_back(corners[i]);
    }
  }
  face.plane = Plane::through(mesh.vertices[contours[0][0]], normal.normalized());
  mesh.corner_normals.resize(mesh.corners.size(), face.plane.normal.cast<float>());
}

/// Returns the prism of contours in the xz-plane from y = 0 to 1. The first contour is
/// counter-clockwise as seen from +y, and holes are clockwise.
inline PolygonMesh swept(const std::vector<std::vector<Vec2>>& contours) {
  PolygonMesh mesh;
  std::vector<std::vector<std::uint32_t>> top, bottom;
  for (const std::vector<Vec2>& contour : contours) {
    auto& upper = top.emplace_back();
    for (const Vec2& p : contour) {
      upper.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.emplace_back(p.x(), 1, p.y());
      mesh.vertices.emplace_back(p.x(), 0, p.y());
    }
    auto& lower = bottom.emplace_back();
    for (auto v = upper.rbegin(); v != upper.rend(); ++v) lower.push_back(*v + 1);
  }
  add_polygon(mesh, top);
  add_polygon(mesh, bottom);
  for (const auto& upper : top) {
    for (std::size_t i = 0; i < upper.size(); ++i) {
      const std::uint32_t a = upper[i], b = upper[(i + 1) % upper.size()];
      add_polygon(mesh, {{a + 1, b + 1, b, a}});
    }
  }
  return mesh;
}

/// Returns a comb of `teeth` teeth, with polygons that a line crosses many times.
inline PolygonMesh comb(int teeth) {
  std::vector<Vec2> outline = {{-1, 1}, {1, 1}};
  for (int i = teeth; i-- > 0;) {
    const double step = 2.0 / (2 * teeth - 1), x = -1 + 2 * i * step;
    if (i + 1 < teeth) outline.emplace_back(x + step, 0.5);
    outline.emplace_back(x + step, -1);
    outline.emplace_back(x, -1);
    if (i > 0) outline.emplace_back(x, 0.5);
  }
  return swept({outline});
}

/// Returns a square ring: faces with a hole, genus 1.
inline PolygonMesh ring() {
  return swept(
      {{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}, {{-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}}});
}

/// Returns a box with a cavity: two shells.
inline PolygonMesh hollow_box() {
  PolygonMesh mesh = polygon_mesh(cube(1));
  const PolygonMesh inner = polygon_mesh(cube(0.5));
  for (const PolygonMesh::Face& face : inner.faces) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t v : inner.contour_corners(face.first_contour)) {
      corners.insert(corners.begin(), v + 8);
    }
    if (mesh.vertices.size() == 8) {
      mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    }
    add_polygon(mesh, {corners});
  }
  return mesh;
}

inline PolygonMesh torus(std::uint32_t around, std::uint32_t tube) {
  PolygonMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < tube; ++j) {
      const SinCos u = sin_cos(6.283185307179586 * i / around);
      const SinCos v = sin_cos(6.283185307179586 * j / tube);
      const double r = 0.7 + 0.3 * v.cos;
      mesh.vertices.emplace_back(r * u.cos, 0.3 * v.sin, -r * u.sin);
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * tube + j % tube; };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < tube; ++j) {
      add_polygon(mesh, {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      add_polygon(mesh, {{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return mesh;
}

inline PolygonMesh random_mesh(Random& random) {
  switch (random.below(5)) {
    case 0:
      return comb(2 + static_cast<int>(random.below(6)));
    case 1:
      return ring();
    case 2:
      return hollow_box();
    case 3:
      return torus(3 + random.below(20), 3 + random.below(10));
    default:
      return polygon_mesh(random_solid(random, 1));
  }
}

inline double volume(const PolygonMesh& mesh) { return mass_properties(mesh).volume_m3; }

}  // namespace sunder::test
