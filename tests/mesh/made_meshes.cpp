#include "tests/mesh/made_meshes.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace sunder::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Makes a ball of `around` vertices about its axis; `radius` is a function of the polar angle and
/// the angle about the axis.
RawMesh ball(std::uint32_t around, const std::function<double(double, double)>& radius) {
  RawMesh mesh;
  const std::uint32_t rings = around / 2;
  const auto point = [&](double ring, double turn) {
    const Vec3 direction(std::sin(ring) * std::cos(turn), std::cos(ring),
                         -std::sin(ring) * std::sin(turn));
    mesh.vertices.push_back(radius(ring, turn) * direction);
  };
  point(0, 0);
  for (std::uint32_t r = 1; r < rings; ++r)
    for (std::uint32_t a = 0; a < around; ++a) point(kPi * r / rings, 2 * kPi * a / around);
  point(kPi, 0);
  const auto at = [&](std::uint32_t r, std::uint32_t a) -> std::uint32_t {
    if (r == 0) return 0;
    return r == rings ? 1 + (rings - 1) * around : 1 + (r - 1) * around + a % around;
  };
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t a = 0; a < around; ++a) {
      if (r > 0) add(mesh, {at(r, a), at(r + 1, a), at(r, a + 1)});
      if (r + 1 < rings) add(mesh, {at(r, a + 1), at(r + 1, a), at(r + 1, a + 1)});
    }
  }
  return mesh;
}

/// Makes a closed tube about a path whose tangent is nowhere vertical.
RawMesh tube(std::uint32_t along, std::uint32_t around, const std::function<Vec3(double)>& path,
             const std::function<double(double, double)>& radius) {
  RawMesh mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    const double t = 2 * kPi * i / along;
    const Vec3 tangent = (path(t + 1e-4) - path(t - 1e-4)).normalized();
    const Vec3 aside = Vec3::UnitY().cross(tangent).normalized(), up = tangent.cross(aside);
    for (std::uint32_t k = 0; k < around; ++k) {
      const double turn = 2 * kPi * k / around;
      mesh.vertices.push_back(path(t) +
                              radius(t, turn) * (std::cos(turn) * aside + std::sin(turn) * up));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return i % along * around + k % around; };
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t k = 0; k < around; ++k) {
      add(mesh, {at(i, k), at(i, k + 1), at(i + 1, k)});
      add(mesh, {at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return mesh;
}

/// Makes a prism from an outline in xz, counter-clockwise from above, along y.
RawMesh prism(const std::vector<Vec2>& outline, double height) {
  RawMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double y : {0.0, height})
    for (const Vec2& p : outline) mesh.vertices.emplace_back(p.x(), y, -p.y());
  Polygon bottom, top;
  for (std::uint32_t i = 0; i < n; ++i) {
    bottom.push_back(n - 1 - i);
    top.push_back(n + i);
    add(mesh, {i, (i + 1) % n, n + (i + 1) % n, n + i});
  }
  add(mesh, bottom);
  add(mesh, top);
  return mesh;
}

RawMesh knot(std::uint32_t along) {
  return tube(
      along, along / 8,
      [](double t) {
        return Vec3(std::sin(t) + 2 * std::sin(2 * t), -std::sin(3 * t),
                    std::cos(t) - 2 * std::cos(2 * t));
      },
      [](double t, double) { return 0.4 + 0.05 * std::sin(5 * t); });
}

const std::map<std::string, std::function<RawMesh()>>& good_meshes() {
  static const std::map<std::string, std::function<RawMesh()>> kAll = {
      {"ball", [] { return make_ball(110); }},  // 12,000 triangles
      {"frame", make_frame},
      {"knot", [] { return knot(160); }},
      {"pebble", [] { return make_ball(24); }},
      {"ring", [] { return make_ring(90); }},
      {"star", [] { return make_star(7, 0.45); }},
  };
  return kAll;
}

}  // namespace

void add(RawMesh& mesh, const Polygon& corners) {
  mesh.polygons.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                           static_cast<std::uint32_t>(corners.size())});
  mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
}

std::vector<Polygon> polygons_of(const RawMesh& mesh) {
  std::vector<Polygon> all;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p)
    all.push_back(Polygon(mesh.polygon_corners(p).begin(), mesh.polygon_corners(p).end()));
  return all;
}

void append(RawMesh& mesh, const RawMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (Polygon corners : polygons_of(other)) {
    for (std::uint32_t& corner : corners) corner += first;
    add(mesh, corners);
  }
}

RawMesh make_ball(std::uint32_t around) {
  return ball(around, [](double ring, double turn) {
    return 1 + 0.12 * std::sin(3 * turn) * std::sin(ring) * std::sin(ring) +
           0.1 * std::cos(5 * ring) + 0.05 * std::sin(9 * turn + 4 * ring) * std::sin(ring);
  });
}

RawMesh make_ring(std::uint32_t along) {
  return tube(
      along, along / 3,
      [](double t) { return Vec3(std::cos(t), 0.2 * std::sin(2 * t), std::sin(t)); },
      [](double t, double turn) {
        return 0.3 + 0.05 * std::sin(4 * t) + 0.03 * std::cos(3 * turn);
      });
}

RawMesh make_star(std::uint32_t points, double inner_radius) {
  std::vector<Vec2> outline;
  for (std::uint32_t i = 0; i < 2 * points; ++i) {
    const double turn = kPi * i / points, r = i % 2 == 0 ? 1 : inner_radius;
    outline.emplace_back(r * std::cos(turn), r * std::sin(turn));
  }
  return prism(outline, 0.4);
}

RawMesh make_frame() {
  RawMesh mesh;
  for (const double y : {0.0, 0.3}) {
    for (const double half : {1.0, 0.5}) {
      for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
        mesh.vertices.emplace_back(half * corner.x(), y, -half * corner.y());
    }
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t k = (i + 1) % 4;
    add(mesh, {k, i, 4 + i, 4 + k});            // Bottom.
    add(mesh, {8 + i, 8 + k, 12 + k, 12 + i});  // Top.
    add(mesh, {i, k, 8 + k, 8 + i});            // Outer side.
    add(mesh, {4 + k, 4 + i, 12 + i, 12 + k});  // Inner side.
  }
  return mesh;
}

RawMesh make_block(const Vec3& low, const Vec3& high, bool is_wedge) {
  std::vector<Vec2> outline = {Vec2(low.x(), -high.z()), Vec2(high.x(), -high.z()),
                               Vec2(high.x(), -low.z()), Vec2(low.x(), -low.z())};
  if (is_wedge) outline.pop_back();
  RawMesh mesh = prism(outline, high.y() - low.y());
  for (Vec3& vertex : mesh.vertices) vertex.y() += low.y();
  return mesh;
}

std::vector<std::string> good_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : good_meshes()) names.push_back(name);
  return names;
}

RawMesh make_good(const std::string& name) { return good_meshes().at(name)(); }

}  // namespace sunder::test
