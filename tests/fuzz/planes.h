// Planes made of a fuzzer's bytes, kPlaneBytes each, most of them nearly degenerate.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder::fuzz {

inline constexpr std::size_t kPlaneBytes = 8;
inline constexpr std::size_t kMaxPlanes = 64;
inline constexpr double kTolerances[] = {0, 0, 1e-13, 1e-9};

/// A cut: its plane, its tolerance in m, and the side that is cut next.
struct Step {
  Plane plane;
  double tolerance = 0;
  bool keep_inside = true;
};

template <class Solid>
Vec3 some_vertex(const Solid& solid, std::uint8_t byte) {
  return solid.vertices[byte % solid.vertices.size()];
}

/// Returns a plane anywhere, on a coarse grid, almost in a face, or through three vertices.
template <class Solid>
Plane read_plane(const std::uint8_t* bytes, const Solid& solid) {
  const auto number = [&](int i) {
    return static_cast<double>(static_cast<std::int8_t>(bytes[i]));
  };
  const auto step = [&](int i) { return static_cast<double>(bytes[i] % 5) - 2; };
  Vec3 normal, point;
  switch (bytes[0] & 3) {
    case 0:
      normal = Vec3(number(1), number(2), number(3));
      point = Vec3(number(4), number(5), number(6) + number(7) / 128) / 128;
      break;
    case 1:
      normal = Vec3(step(1), step(2), step(3));
      point = Vec3(step(4), step(5), step(6)) / 2;
      break;
    case 2: {
      const Plane face = solid.faces[bytes[1] % solid.faces.size()].plane;
      const Vec3 turn(number(2), number(3), number(4));
      normal = face.normal + std::ldexp(1.0, -30 - bytes[5] % 32) * turn;
      point = some_vertex(solid, bytes[6]) - std::ldexp(number(7), -50) * face.normal;
      break;
    }
    default: {
      point = some_vertex(solid, bytes[1]);
      const Vec3 along = some_vertex(solid, bytes[2]) - point;
      normal = along.cross(some_vertex(solid, bytes[3]) - point) +
               std::ldexp(number(4), -40) * Vec3(step(5), step(6), step(7));
    }
  }
  const double length = normal.norm();
  return Plane::through(point, length > 1e-100 ? Vec3(normal / length) : Vec3::UnitY());
}

template <class Solid>
Step read_step(const std::uint8_t* bytes, const Solid& solid) {
  return {read_plane(bytes, solid), kTolerances[bytes[0] >> 2 & 3], (bytes[0] & 16) != 0};
}

}  // namespace sunder::fuzz
