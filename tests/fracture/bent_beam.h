// Test fixture: a beam that is split at a section and bent there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/random.h"
#include "engine/geometry/mitre.h"
#include "engine/model/breaker.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/stress/bond_geometry.h"

namespace sunder::fracture {

inline constexpr double kRadian = 3.14159265358979323846 / 180;

/// Two parts of a compound, and the section between them.
struct Halves {
  Compound a, b;
  BentSection section;
};

/// Returns true if a face lies in a plane, on either side of it.
inline bool lies_in_plane(const Convex& convex, std::uint32_t face, const Plane& plane) {
  const Plane& own = convex.polyhedron.faces[face].plane;
  const Plane other = own.normal.dot(plane.normal) < 0 ? own.flipped() : own;
  return (other.normal - plane.normal).norm() < 1e-6 && std::abs(other.d - plane.d) < 1e-6;
}

/// Splits a compound in two by removing the bonds that cross a plane; part a is below the plane.
/// Returns empty halves if the parts are not two.
inline Halves split_at_plane(const Compound& whole, const Plane& plane) {
  const auto crosses = [&](const Bond& bond) {
    return lies_in_plane(*whole.convexes[bond.a], bond.face_a, plane) &&
           lies_in_plane(*whole.convexes[bond.b], bond.face_b, plane);
  };
  Compound apart = whole;
  std::erase_if(apart.bonds, crosses);
  std::vector<Compound> parts = split_islands(apart);
  if (parts.size() != 2) return {};
  if (plane.distance(parts[0].convexes[0]->solid.centroid) > 0) std::swap(parts[0], parts[1]);
  Halves halves{parts[0], parts[1], {}};
  BentSection& section = halves.section;
  const auto place = [](const Compound& in, const ConvexPtr& convex) {
    return static_cast<std::uint32_t>(std::ranges::find(in.convexes, convex) - in.convexes.begin());
  };
  double area_m2 = 0;
  std::vector<Vec3> corners;
  for (Bond bond : whole.bonds) {
    if (!crosses(bond)) continue;
    const BondGeometry geometry = bond_geometry(whole, bond);
    area_m2 += bond.area_m2;
    section.areas_m2.push_back(bond.area_m2);
    section.centroid_A += bond.area_m2 * geometry.centroid_R;
    const ConvexPtr *inner = &whole.convexes[bond.a], *outer = &whole.convexes[bond.b];
    if (place(halves.a, *inner) == halves.a.convexes.size()) {
      std::swap(inner, outer);
      std::swap(bond.face_a, bond.face_b);
    }
    section.slots_a.push_back(place(halves.a, *inner)), section.faces_a.push_back(bond.face_a);
    section.slots_b.push_back(place(halves.b, *outer)), section.faces_b.push_back(bond.face_b);
    for (const std::uint32_t v : (*inner)->polyhedron.face_corners(bond.face_a))
      corners.push_back((*inner)->polyhedron.vertices[v]);
  }
  section.centroid_A /= area_m2;
  section.centroid_B = section.centroid_A;
  section.normal_A = plane.normal, section.normal_B = -plane.normal;
  for (const Vec3& corner : corners)
    section.reach_m = std::max(section.reach_m, (corner - section.centroid_A).norm());
  return halves;
}

/// Returns the pose of side B after a rotation about the section's centroid and a shift by `gap`.
inline Pose rotate_about_section(const BentSection& section, const Quat& turn,
                                 const Vec3& gap = Vec3::Zero()) {
  return {section.centroid_A - turn * section.centroid_B + gap, turn};
}

/// Structures of two halves, with the pair that rejoin_bent() takes.
struct Bent {
  Structure a, b;
  BentPair pair;

  Bent(const Halves& halves, const Pose& X_AB, std::uint64_t event = 1)
      : a(halves.a), b(halves.b), pair{a, b, X_AB, {halves.section}, event} {}
  Plane midplane() const {
    const BentSection& s = pair.sections[0];
    return sunder::midplane({s.centroid_A, s.normal_A}, {s.centroid_B, s.normal_B}, pair.X_AB)->a;
  }
};

}  // namespace sunder::fracture
