// Plane sections of a compound: the bonds that a plane through one of them crosses, their plastic
// strength, and their utilisation under a load.
//
// The shape of a bond enters as that of a rectangle with its area and second moment, which is exact
// for boxes; polygons are not needed.
//
// Read first: Sections::at().
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/model/compound.h"
#include "engine/model/section.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {

/// A bond that crosses the plane of a section.
struct Crossing {
  std::uint32_t bond = 0;
  bool forward = true;  ///< Its convex b is ahead of the plane.
};

/// Connected bonds that one plane crosses.
struct Section {
  std::vector<Crossing> crossings;  ///< In the order of bonds; empty: there is no such section.
  /// Further bonds of the section that do not yield and are under compression, ascending: when the
  /// section flows, only the contact of their convexes remains.
  std::vector<std::uint32_t> compressed;
  Vec3 centroid_R = Vec3::Zero();
  double area_m2 = 0;  ///< Area of the bonds, projected along the normal.
  /// The second axis is the axis of bending under the load.
  SectionStrength strength;
  Wrench wrench_R;  ///< Wrench that the part ahead exerts on the part behind.
  double utilisation = 0;

  Vec3 normal_R() const { return strength.axes_R.col(0); }
};

/// Sections of one compound under the load that its displacements belong to.
class Sections {
 public:
  Sections(const Compound& compound, const StressSystem& system,
           std::span<const Displacement> displacements, std::span<const Material> materials);

  /// Returns the yield stress of a bond; 0 if it does not yield.
  double yield_Pa(std::uint32_t bond) const;
  /// Returns the absolute cosine between a bond's normal and a direction.
  double normal_cosine(std::uint32_t bond, const Vec3& direction_R) const {
    return std::abs(system_.geometry()[bond].normal_R.dot(direction_R));
  }
  /// Returns the section about a bond that yields; none if it has too many bonds, or a bond that
  /// neither yields nor is under compression.
  ///
  /// If the bond lies in a plane of bonds, these are the section; where the convexes beside it are
  /// prisms, as at a mitre, the section is seen along their axis. Otherwise, as among Voronoi
  /// cells, the bonds are those at a plane across the member. Of several planes, normal to the
  /// principal axes of the cells around, the one with least area is taken.
  Section at(std::uint32_t bond);
  /// Returns the section of given bonds, seen along `normal_R`; none if the projected area of the
  /// bonds that yield is zero.
  Section make_section(std::vector<Crossing> crossings, const Vec3& normal_R) const;
  /// Returns the number of bonds visited so far.
  std::uint64_t work() const { return work_; }

 private:
  void index_bonds();
  std::span<const std::uint32_t> bonds_of(std::uint32_t convex) const;
  const Vec3& centroid(std::uint32_t convex) const;
  std::uint32_t other_convex(std::uint32_t bond, std::uint32_t convex) const;
  bool is_compressed(std::uint32_t bond) const;
  std::vector<Crossing> find_crossings(std::uint32_t bond, const Vec3& normal_R);
  Vec3 vector_area(std::span<const Crossing> crossings, double& area_m2) const;
  std::vector<Vec3> axes_around(std::uint32_t bond);
  SectionStrength strength(std::span<const Crossing> crossings, std::span<const double> areas_m2,
                           const Vec3& normal_R, const Vec3& bending_R) const;

  const Compound& compound_;
  const StressSystem& system_;
  std::span<const Displacement> displacements_;
  std::span<const Material> materials_;
  /// The bonds of convex c: from first_[c] to the next.
  std::vector<std::uint32_t> first_, bonds_;
  /// Pairs of convexes, in both orders.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> overlaps_;
  std::vector<std::uint32_t> seen_bond_, seen_convex_;  ///< Number of the search that visited each.
  std::uint32_t search_ = 0;
  std::uint64_t work_ = 0;
};

}  // namespace sunder::fracture
