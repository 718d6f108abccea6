// Test helpers: volumes, coverage, winding numbers and hashes of compounds and break plans.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/base/hash.h"
#include "engine/base/random.h"
#include "engine/geometry/polygon_mesh.h"
#include "engine/model/breaker.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/adjacency/overlap.h"
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

/// Returns the number of convexes of a compound that contain a point, corrected by its ghosts.
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
    if (convex->is_internal()) continue;
    for (const Vec3& vertex : convex->visual->vertices) {
      for (int k = 0; k < 3; ++k) hash = combine(hash, bits_of(vertex[k]));
    }
    for (const std::uint32_t corner : convex->visual->corners) hash = combine(hash, corner);
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

/// Returns a hash over convexes with their contacts and overlaps, independent of their order.
inline std::uint64_t hash_any_order(const Compound& compound) {
  std::vector<std::uint64_t> hashes;
  for (const ConvexPtr& convex : compound.convexes) {
    hashes.push_back(hash_of(Compound{{convex}, {}, {}, {}}));
  }
  const std::vector<std::uint64_t> own = hashes;
  for (std::size_t c = 0; c < own.size(); ++c) hashes[c] = combine(own[c], compound.anchored[c]);
  for (const Bond& bond : compound.bonds) {  // Sums do not depend on the order.
    hashes[bond.a] += combine(own[bond.b], bits_of(bond.area_m2) + bond.face_a);
    hashes[bond.b] += combine(own[bond.a], bits_of(bond.area_m2) + bond.face_b);
  }
  for (const Ghost& ghost : compound.ghosts) {
    const std::uint64_t hash = hash_of(Compound{{ghost.convex}, {}, {}, {}});
    for (const std::uint32_t c : ghost.of) hashes[c] += combine(hash, bits_of(ghost.sign));
  }
  std::sort(hashes.begin(), hashes.end());
  std::uint64_t hash = 2;
  for (const std::uint64_t part : hashes) hash = combine(hash, part);
  return hash;
}
inline std::uint64_t hash_any_order(const BreakPlan& plan) {
  std::vector<std::uint64_t> hashes;
  for (const Compound& piece : plan.pieces) hashes.push_back(hash_any_order(piece));
  std::sort(hashes.begin(), hashes.end());
  std::uint64_t hash = 3;
  for (const std::uint64_t piece : hashes) hash = combine(hash, piece);
  return hash;
}

/// Returns the compound with its convexes in another order: new convex i is the old `order[i]`.
inline Compound reordered(const Compound& compound, const std::vector<std::uint32_t>& order) {
  Compound result;
  std::vector<std::uint32_t> new_of_old(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    new_of_old[order[i]] = i;
    result.convexes.push_back(compound.convexes[order[i]]);
    result.anchored.push_back(compound.anchored[order[i]]);
  }
  for (Bond bond : compound.bonds) {
    bond.a = new_of_old[bond.a];
    bond.b = new_of_old[bond.b];
    if (bond.a > bond.b) {
      std::swap(bond.a, bond.b);
      std::swap(bond.face_a, bond.face_b);
    }
    result.bonds.push_back(bond);
  }
  sort_bonds(result.bonds);
  for (Ghost ghost : compound.ghosts) {
    for (std::uint32_t& c : ghost.of) c = new_of_old[c];
    std::sort(ghost.of.begin(), ghost.of.end());
    result.ghosts.push_back(std::move(ghost));
  }
  sort_ghosts(result.ghosts);
  return result;
}

/// Returns the winding number around a point, by solid angles (Van Oosterom and Strackee 1983).
inline double winding(const ConvexPolyhedron& polyhedron, const Vec3& point) {
  double angle = 0;
  for (std::size_t f = 0; f < polyhedron.faces.size(); ++f) {
    const auto corners = polyhedron.face_corners(f);
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 a = polyhedron.vertices[corners[0]] - point;
      const Vec3 b = polyhedron.vertices[corners[i - 1]] - point;
      const Vec3 c = polyhedron.vertices[corners[i]] - point;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      angle += 2 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
  }
  return angle / (4 * std::numbers::pi);
}
inline double winding(const Compound& compound, const Vec3& point) {
  double sum = 0;
  for (const ConvexPtr& convex : compound.convexes) sum += winding(convex->polyhedron, point);
  for (const Ghost& ghost : compound.ghosts) {
    sum += ghost.sign * winding(ghost.convex->polyhedron, point);
  }
  return sum;
}

/// Returns a compound of boxes that may overlap.
inline Compound compound_of(const std::vector<Box>& boxes) {
  std::vector<Part> parts;
  for (const Box& box : boxes) {
    parts.push_back({make_box(box.min, box.max), MaterialIndex(0u), 0});
  }
  return make_compound(std::move(parts));
}

/// Returns boxes in and around the unit cube, many of which overlap.
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
