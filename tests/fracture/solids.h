// Solids to break in tests and benchmarks, and what must be true of what comes out.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "engine/base/hash.h"
#include "engine/base/random.h"
#include "engine/world/breaker.h"
#include "fracture/compound_builder.h"
#include "fracture/pattern.h"
#include "fracture/voronoi.h"

namespace sunder::fracture {

inline Compound box_compound(const Vec3& min, const Vec3& max, std::uint8_t anchored = 0) {
  return make_compound({{make_box(min, max), MaterialIndex(0u), anchored}});
}

/// nx × ny × nz touching boxes of a given size, one corner at the origin; anchored below.
inline Compound grid_compound(int nx, int ny, int nz, const Vec3& size = Vec3::Ones(),
                              bool anchored = false) {
  std::vector<Part> parts;
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      for (int z = 0; z < nz; ++z) {
        const Vec3 min = size.cwiseProduct(Vec3(x, y, z));
        const Vec3 max = size.cwiseProduct(Vec3(x + 1, y + 1, z + 1));
        const bool held = anchored && y == 0;
        parts.push_back({make_box(min, max), MaterialIndex(0u), static_cast<std::uint8_t>(held)});
      }
    }
  }
  return make_compound(std::move(parts));
}

/// The unit cube in `count` Voronoi cells.
inline Compound voronoi_compound(int count, std::uint64_t seed) {
  Random random(seed, 77);
  std::vector<Vec3> sites;
  for (int i = 0; i < count; ++i) {
    sites.emplace_back(random.uniform(-.5, .5), random.uniform(-.5, .5), random.uniform(-.5, .5));
  }
  std::vector<Plane> planes = box_planes();
  const ConvexPolyhedron solid = make_box(Vec3::Constant(-.5), Vec3::Constant(.5));
  std::vector<Part> parts;
  for (ConvexPolyhedron& cell : voronoi_cells(sites, solid, planes)) {
    if (!cell.empty()) parts.push_back({std::move(cell), MaterialIndex(0u), 0});
  }
  return make_compound(std::move(parts), 1e-9);
}

/// A ring of prisms around y.
inline Compound ring_compound(int segments, double inner, double outer, double height) {
  std::vector<Part> parts;
  for (int i = 0; i < segments; ++i) {
    const double a = 2 * 3.14159265358979 * i / segments;
    const double b = 2 * 3.14159265358979 * (i + 1) / segments;
    const auto at = [](double r, double angle) {
      return Vec2(r * std::cos(angle), r * std::sin(angle));
    };
    // Counter-clockwise seen from +y is clockwise in (x, z).
    const Vec2 polygon[] = {at(inner, b), at(outer, b), at(outer, a), at(inner, a)};
    parts.push_back({make_prism(polygon, 0, height, false), MaterialIndex(0u), 0});
  }
  return make_compound(std::move(parts));
}

inline double total_volume(const BreakPlan& plan) {
  double sum = plan.debris_volume_m3;
  for (const Compound& piece : plan.pieces) sum += volume(piece);
  return sum;
}

inline bool contains(const ConvexPolyhedron& convex, const Vec3& point) {
  for (const auto& face : convex.faces) {
    if (face.plane.distance(point) > 0) return false;
  }
  return true;
}

/// How many convexes of the plan a point lies in.
inline int cover(const BreakPlan& plan, const Vec3& point) {
  int count = 0;
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) count += contains(convex->polyhedron, point);
  }
  return count;
}

inline std::uint64_t bits_of(double value) {
  std::uint64_t bits;
  static_assert(sizeof bits == sizeof value);
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline std::uint64_t hash_of(const Compound& compound) {
  std::uint64_t hash = 1;
  for (const ConvexPtr& convex : compound.convexes) {
    for (const Vec3& vertex : convex->polyhedron.vertices) {
      for (int k = 0; k < 3; ++k) hash = combine(hash, bits_of(vertex[k]));
    }
    for (const auto& face : convex->polyhedron.faces) hash = combine(hash, face.id.value);
  }
  for (const Bond& bond : compound.bonds) hash = combine(hash, bits_of(bond.area_m2));
  return hash;
}

inline std::uint64_t hash_of(const BreakPlan& plan) {
  std::uint64_t hash = 0;
  for (const Compound& piece : plan.pieces) hash = combine(hash, hash_of(piece));
  return combine(hash, bits_of(plan.new_area_m2));
}

}  // namespace sunder::fracture
