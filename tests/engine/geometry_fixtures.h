// Random solids and planes for the geometry tests, and functions that cut and measure solids.
#pragma once

#include <vector>

#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"

namespace sunder::test {

inline Vec3 random_point(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

inline Plane random_plane(Random& random, double reach) {
  return Plane::through(random_point(random, reach), random.direction());
}

inline Pose random_pose(Random& random, double reach) {
  const Vec3 axis = random.direction();
  const SinCos half = sin_cos(random.uniform(0, 3.14));
  return {random_point(random, reach),
          Quat(half.cos, half.sin * axis.x(), half.sin * axis.y(), half.sin * axis.z())};
}

inline ConvexPolyhedron cube(double size) {
  return make_box(Vec3::Constant(-size), Vec3::Constant(size));
}

/// Returns a regular polygon in the xz-plane, counter-clockwise as seen from +y.
inline std::vector<Vec2> regular_polygon(int sides, double radius) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < sides; ++i) {
    const SinCos at = sin_cos(2 * 3.14159265358979323846 * i / sides);
    polygon.emplace_back(radius * at.cos, -radius * at.sin);
  }
  return polygon;
}

/// Returns a box, prism, turned box or hull of random points within about [-size, size]³.
inline ConvexPolyhedron random_solid(Random& random, double size) {
  switch (random.below(4)) {
    case 0:
      return cube(size);
    case 1: {
      const int sides = 3 + static_cast<int>(random.below(20));
      return make_prism(regular_polygon(sides, size), -size, size, true);
    }
    case 2:
      return transformed(cube(0.5 * size), random_pose(random, 0.5 * size));
    default: {
      std::vector<Vec3> points(4 + random.below(30));
      for (Vec3& p : points) p = random_point(random, size);
      return make_hull(points);
    }
  }
}

/// Both sides of a cut; a side without volume is an empty polyhedron.
struct Halves {
  ConvexPolyhedron inside, outside;
};

inline Halves split(const ConvexPolyhedron& solid, const Plane& plane, double tolerance) {
  ClipScratch scratch;
  ConvexPolyhedron result;
  const auto side = [&](const Plane& p, PlaneId id) -> ConvexPolyhedron {
    switch (clip(solid, p, id, tolerance, result, scratch)) {
      case PlaneSide::kInside:
        return solid;
      case PlaneSide::kOutside:
        return {};
      default:
        return result;
    }
  };
  const PlaneId id{2};
  return {side(plane, id), side(plane.flipped(), id.opposite())};
}

inline double volume(const ConvexPolyhedron& solid) { return mass_properties(solid).volume_m3; }

/// True if each corner lies within `tolerance` of its face's plane and of the inside of all others.
inline bool is_convex(const ConvexPolyhedron& solid, double tolerance) {
  for (const ConvexPolyhedron::Face& face : solid.faces) {
    for (const Vec3& v : solid.vertices) {
      if (face.plane.distance(v) > tolerance) return false;
    }
    for (std::uint32_t c = 0; c < face.corner_count; ++c) {
      const Vec3& v = solid.vertices[solid.corners[face.first_corner + c]];
      if (std::abs(face.plane.distance(v)) > tolerance) return false;
    }
  }
  return true;
}

}  // namespace sunder::test
