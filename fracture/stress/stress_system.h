// Stress in the bonds of a compound under self-weight and slow loads. Convexes are rigid, and each
// bond is a distributed spring.
//
// A bond has the stiffness E/d per area, where d is the distance of its convexes along its normal.
// It resists tension, shear, bending and twist, and its stress varies linearly over its area.
//
// Read first: StressSystem, then stress_breaks.h, which uses it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "engine/model/compound.h"
#include "engine/model/section.h"
#include "fracture/stress/bond_geometry.h"
#include "fracture/stress/convex_masses.h"
#include "fracture/stress/multigrid.h"

namespace sunder::fracture {

/// Greatest stresses over a bond's area, in Pa; all at least 0.
struct BondStress {
  double tension_Pa = 0;
  double compression_Pa = 0;
  double shear_Pa = 0;
};

/// Indices of convexes and bonds in another system, ascending, or kNew.
struct StressOrigin {
  static constexpr std::uint32_t kNew = ConvexMasses::kNew;
  std::vector<std::uint32_t> convexes, bonds;
};

/// The springs of one compound. The system is edited when bonds change, and reused when loads do.
///
/// Anchored convexes do not move. An island without an anchor is solved in its own accelerated and
/// rotating frame: only loads that are not balanced by rigid acceleration, and its spin, strain it.
class StressSystem {
 public:
  StressSystem() = default;
  /// `geometry` is the geometry of the compound's bonds.
  StressSystem(const Compound& compound, std::vector<BondGeometry> geometry,
               std::span<const Material> materials, std::size_t spare_nodes = 0);
  /// Makes the system of what the compound of `old` has become. Stresses equal those of a new
  /// system but for rounding. The cost is lower, unless there are ghosts or the system needs more
  /// nodes than `old` has.
  StressSystem(const StressSystem& old, const Compound& compound,
               std::vector<BondGeometry> geometry, std::span<const Material> materials,
               const StressOrigin& origin);

  /// Returns a number of spare nodes that suffices for some edits.
  static std::size_t spare_nodes(const Compound& compound) { return compound.convexes.size() / 8; }

  /// Returns the geometry of the compound's bonds.
  const std::vector<BondGeometry>& geometry() const { return geometry_; }
  /// Returns the cost of an iteration, in evaluations of springs.
  std::uint64_t work() const { return springs_; }
  /// Return the approximate cost of making the system anew, or as an edit.
  std::uint64_t set_up_work() const { return 20 * springs_ + direct_work(); }
  std::uint64_t edit_work() const { return 4 * springs_ + direct_work(); }
  /// Improves the displacements, one per convex, under loads, weight and spin (rad/s).
  /// `last_direction` is the last search direction of an unfinished solve of this system; it is
  /// used to continue that solve and updated.
  SolveResult solve(std::span<const ConvexLoad> loads, const Vec3& gravity_R, double tolerance,
                    int most_iterations, std::vector<Displacement>& displacements,
                    const Vec3& spin_R = Vec3::Zero(),
                    Nodal<double>* last_direction = nullptr) const;

  /// Returns work and modal mass of displacements that the loads alone have caused.
  DeflectionResponse response(std::span<const ConvexLoad> loads,
                              std::span<const Displacement> displacements) const {
    return masses_.response(loads, displacements);
  }

  /// Returns the strain energy of the bonds whose centroids are within a sphere.
  double energy_J(std::span<const Displacement> displacements, const Vec3& center_R,
                  double radius_m) const;

  /// Returns the wrench that convex b of a bond exerts on convex a, about the bond's centroid. The
  /// wrenches of all bonds balance the loads, even where the stress in one bond is inaccurate.
  Wrench wrench(std::uint32_t bond, std::span<const Displacement> displacements) const;
  /// Returns the wrench that the second convex of an overlap exerts on the first, about the
  /// centroid of the overlap, which is as stiff as a cube of its volume.
  Wrench overlap_wrench(const Ghost& ghost, std::span<const Material> materials,
                        std::span<const Displacement> displacements) const;
  /// Returns an upper bound of the stresses over the bond's own area.
  BondStress bound(std::uint32_t bond, std::span<const Displacement> displacements) const;
  /// Returns the greatest stresses at the corners of a bond of `compound`, which is the system's.
  /// Tension and compression are those of the plane fitted to the bond and its neighbours in one
  /// plane: the bending of the section, however it is divided into bonds.
  BondStress stress(const Compound& compound, std::uint32_t bond,
                    std::span<const Displacement> displacements) const;

  static auto fields(auto& self) {
    return std::tie(self.geometry_, self.masses_, self.node_of_convex_, self.bonds_, self.by_plane_,
                    self.springs_, self.nodes_, self.overlaps_, self.multigrid_);
  }
  /// Returns true if the system is of this compound's size.
  bool fits(std::size_t convexes, std::size_t bonds) const {
    return masses_.size() == convexes && bonds_.size() == bonds;
  }
  /// Returns the number of nodes with their one for the world: the size of a search direction.
  std::size_t directions() const { return multigrid_ ? multigrid_->springs().size() + 1 : 0; }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  /// The spring of a bond, from the displacements of two convexes to stress.
  struct ElasticBond {
    std::uint32_t a = 0, b = 0;
    double stiffness_Pa_m = 0;  ///< E/d; 0 if the bond has no area.
    double window_m = 0;        ///< Bonds of one plane are neighbours up to this distance.
    std::uint64_t plane = 0;
  };
  /// Stress over a bond, linear in the position.
  struct Field {
    double mean_Pa = 0;              ///< Tension at the centroid.
    Vec3 slope_Pa_m = Vec3::Zero();  ///< Gradient of the tension.
    Vec3 shear_Pa = Vec3::Zero();
    double twist_Pa_m = 0;
  };

  /// The system that an edit starts from.
  struct Edited {
    const StressSystem& old;
    const StressOrigin& origin;
  };

  std::uint64_t direct_work() const { return multigrid_ ? multigrid_->direct_work() : 0; }
  bool number_nodes(const Edited& edited, SpringEdit& edit);
  void make_bonds(const Compound& compound, std::span<const Material> materials,
                  const Edited* edited);
  ElasticBond make_bond(const Compound& compound, std::uint32_t number,
                        std::span<const Material> materials) const;
  void mark_changes(const Edited& edited, SpringEdit& edit) const;
  bool has_spring(std::uint32_t bond) const;
  Spring spring_of(std::uint32_t bond) const;
  Spring spring_of(const Ghost& ghost, std::size_t i, std::span<const Material> materials) const;
  void add_overlaps(const Compound& compound, std::span<const Material> materials,
                    std::vector<Spring>& springs) const;
  Field field(std::uint32_t bond, std::span<const Displacement> displacements) const;
  Field section_field(std::uint32_t bond, std::span<const Displacement> displacements) const;

  std::vector<BondGeometry> geometry_;
  ConvexMasses masses_;
  std::vector<std::uint32_t> node_of_convex_;  ///< Spring::kWorld if the convex is fixed.
  std::vector<ElasticBond> bonds_;             ///< Per bond.
  std::vector<std::uint32_t> by_plane_;        ///< Bonds sorted by plane, then by index.
  std::uint64_t springs_ = 0;
  std::size_t nodes_ = 0;                       ///< Includes unused nodes.
  bool overlaps_ = false;                       ///< The compound has ghosts.
  std::shared_ptr<const Multigrid> multigrid_;  ///< Null if nothing can move.
};

}  // namespace sunder::fracture
