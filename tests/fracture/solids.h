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
