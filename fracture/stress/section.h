// Plane sections of a compound: the bonds that a plane crosses about one of them, what they bear
// when all of them flow, and what a load asks of them.
//
// Nothing here needs polygons: how a bond's area lies about an axis is taken to be that of the
// rectangle of its area and second moment, which is exact for boxes.
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

/// A bond that leads from one side of a plane to the other.
struct Crossing {
  std::uint32_t bond = 0;
  bool forward = true;  ///< Its convex b is the one ahead of the plane.
};

/// Bonds that one plane crosses, and that hang together there.
struct Section {
  std::vector<Crossing> crossings;  ///< In the order of bonds; empty: there is no such section.
  /// Bonds beside these that do not yield and are pressed, ascending: what is left of them when the
  /// section flows is that their convexes touch.
  std::vector<std::uint32_t> pressed;
  Vec3 centroid_R = Vec3::Zero();
  double area_m2 = 0;  ///< Of the bonds, seen along the normal.
  /// Its second axis is the one that the load bends it about.
  SectionStrength strength;
  Wrench wrench_R;  ///< What is ahead of it does to what is behind.
  double utilisation = 0;

  Vec3 normal_R() const { return strength.axes_R.col(0); }
};

/// The sections of one compound, whose bonds bear what its displacements say.
class Sections {
 public:
  Sections(const Compound& compound, const StressSystem& system,
           std::span<const Displacement> displacements, std::span<const Material> materials);

  /// At which a bond flows; 0: it does not.
  double yield_Pa(std::uint32_t bond) const;
  /// The cosine between a bond's normal, either way, and a direction.
  double faces(std::uint32_t bond, const Vec3& direction_R) const {
    return std::abs(system_.geometry()[bond].normal_R.dot(direction_R));
  }
  /// The section about a bond that yields. There is none if it would be very large, or if a bond
  /// is in it that neither yields nor is pressed.
  ///
  /// Where the bond lies in a plane of bonds that is the section. It may be a mitre: if the
  /// convexes beside it are prisms it is seen the way they run. Elsewhere, as among Voronoi cells,
  /// its bonds are those at a plane across the member, whose direction is a principal axis of the
  /// cells around: of a few, that with the least of them.
  Section at(std::uint32_t bond);
  /// The section that these bonds are, seen along a direction; none if those that yield have no
  /// area so.
  Section of(std::vector<Crossing> crossings, const Vec3& normal_R) const;
  /// Bonds visited so far.
  std::uint64_t work() const { return work_; }

 private:
  void index_bonds();
  std::span<const std::uint32_t> bonds_of(std::uint32_t convex) const;
  const Vec3& centroid(std::uint32_t convex) const;
  std::uint32_t across(std::uint32_t bond, std::uint32_t convex) const;
  bool is_pressed(std::uint32_t bond) const;
  std::vector<Crossing> flood(std::uint32_t bond, const Vec3& normal_R);
  Vec3 facing(std::span<const Crossing> crossings, double& area_m2) const;
  std::vector<Vec3> axes_around(std::uint32_t bond);
  SectionStrength strength(std::span<const Crossing> crossings, std::span<const double> areas_m2,
                           const Vec3& normal_R, const Vec3& bending_R) const;

  const Compound& compound_;
  const StressSystem& system_;
  std::span<const Displacement> displacements_;
  std::span<const Material> materials_;
  std::vector<std::uint32_t> first_, bonds_;  ///< Those of convex c: from first_[c] to the next.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> overlaps_;  ///< Convexes, both ways round.
  std::vector<std::uint32_t> seen_bond_, seen_convex_;             ///< In which search.
  std::uint32_t search_ = 0;
  std::uint64_t work_ = 0;
};

}  // namespace sunder::fracture
