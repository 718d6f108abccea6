// Figures of breaks that tests compare.
#pragma once

#include <cstdint>

#include "engine/base/hash.h"
#include "engine/base/random.h"
#include "engine/world/breaker.h"
#include "fracture/compound_builder.h"
#include "fracture/solids.h"

namespace sunder::fracture {

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

/// How many convexes of a compound a point lies in, less what its ghosts take back.
inline int cover(const Compound& compound, const Vec3& point) {
  int count = 0;
  for (const ConvexPtr& convex : compound.convexes) count += contains(convex->polyhedron, point);
  for (const Ghost& ghost : compound.ghosts) {
    count += ghost.sign * (contains(ghost.convex->polyhedron, point) ? 1 : 0);
  }
  return count;
}
inline int cover(const BreakPlan& plan, const Vec3& point) {
  int count = 0;
  for (const Compound& piece : plan.pieces) count += cover(piece, point);
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
  for (const Ghost& ghost : compound.ghosts) {
    for (const std::uint32_t of : ghost.of) hash = combine(hash, of);
    hash = combine(hash, bits_of(ghost.sign * ghost.convex->solid.volume_m3));
  }
  for (const Bond& bond : compound.bonds) hash = combine(hash, bits_of(bond.area_m2));
  return hash;
}

inline std::uint64_t hash_of(const BreakPlan& plan) {
  std::uint64_t hash = 0;
  for (const Compound& piece : plan.pieces) hash = combine(hash, hash_of(piece));
  return combine(hash, bits_of(plan.new_area_m2));
}

/// Boxes that may overlap, as a compound.
inline Compound compound_of(const std::vector<Box>& boxes) {
  std::vector<Part> parts;
  for (const Box& box : boxes) {
    parts.push_back({make_box(box.min, box.max), MaterialIndex(0u), 0});
  }
  return make_compound(std::move(parts));
}

/// Boxes many of which overlap.
inline std::vector<Box> random_boxes(Random& random, std::uint32_t count) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 low(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    const Vec3 size(random.uniform(.3, 1), random.uniform(.3, 1), random.uniform(.3, 1));
    boxes.push_back({low, low + size});
  }
  return boxes;
}

}  // namespace sunder::fracture
