// Own weight and slow load: stress on the bonds of a compound, which is taken as rigid convexes on
// distributed springs, one a bond.
//
// Each bond has the stiffness E/d per area, d the distance of its convexes along its normal; so it
// resists tension, shear, bending and twist, and the stress over it is linear in the place.
//
// Read first: StressSystem. Then stress_breaks.h for what follows from it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/compound.h"
#include "engine/model/section.h"
#include "fracture/stress/bond_geometry.h"
#include "fracture/stress/convex_masses.h"
#include "fracture/stress/multigrid.h"

namespace sunder::fracture {

/// The worst stresses over a bond's area, in Pa, all >= 0.
struct BondStress {
  double tension_Pa = 0;
  double compression_Pa = 0;
  double shear_Pa = 0;
};

/// Where convexes and bonds were in another system: their numbers there, ascending, or kNew.
struct StressOrigin {
  static constexpr std::uint32_t kNew = ConvexMasses::kNew;
  std::vector<std::uint32_t> convexes, bonds;
};

/// The springs of one compound; edited when its bonds change, kept while loads do.
///
/// Anchored convexes do not move. An island without any is taken at rest in its own falling and
/// rotating frame: it feels only what does not accelerate all of it alike, and what its spin does.
class StressSystem {
 public:
  /// `geometry` is that of the compound's bonds.
  StressSystem(const Compound& compound, std::vector<BondGeometry> geometry,
               std::span<const Material> materials, std::size_t spare_nodes = 0);
  /// The system of what `old` has become. Stresses are those of one made anew, but for rounding; it
  /// costs less, unless there are ghosts or it needs more nodes than `old` has.
  StressSystem(const StressSystem& old, const Compound& compound,
               std::vector<BondGeometry> geometry, std::span<const Material> materials,
               const StressOrigin& origin);

  /// So many that a compound may be edited for a while.
  static std::size_t spare_nodes(const Compound& compound) { return compound.convexes.size() / 8; }

  /// Of the compound's bonds.
  const std::vector<BondGeometry>& geometry() const { return geometry_; }
  /// What an iteration costs, in visits of springs,
  std::uint64_t work() const { return springs_; }
  /// and what it costs, about, to make the system anew or as an edit.
  std::uint64_t set_up_work() const { return 20 * springs_ + direct_work(); }
  std::uint64_t edit_work() const { return 4 * springs_ + direct_work(); }
  /// Improves the displacements, one per convex, under loads, weight and spin (rad/s). `way`, of
  /// this system: where an unfinished solve left off, for the next to go on from.
  SolveResult solve(std::span<const ConvexLoad> loads, const Vec3& gravity_R, double tolerance,
                    int most_iterations, std::vector<Displacement>& displacements,
                    const Vec3& spin_R = Vec3::Zero(), Nodal<double>* way = nullptr) const;

  /// Of displacements that the loads alone have led to.
  SwingResponse response(std::span<const ConvexLoad> loads,
                         std::span<const Displacement> displacements) const {
    return masses_.response(loads, displacements);
  }

  /// Of the springs of bonds whose centroids are within a sphere.
  double energy_J(std::span<const Displacement> displacements, const Vec3& center_R,
                  double radius_m) const;

  /// What convex b of a bond does to convex a, about the bond's centroid. Of all bonds together it
  /// balances the loads, however far the stress in one of them is from that of a beam.
  Wrench wrench(std::uint32_t bond, std::span<const Displacement> displacements) const;
  /// Wrench that the second convex of an overlap exerts on the first, about the centroid of the
  /// overlap, which holds them like a cube of its volume.
  Wrench overlap_wrench(const Ghost& ghost, std::span<const Material> materials,
                        std::span<const Displacement> displacements) const;
  /// No less than any stress over the bond's own area.
  BondStress bound(std::uint32_t bond, std::span<const Displacement> displacements) const;
  /// The worst at the corners of a bond of `compound`, for which this was made. Tension and
  /// compression are those of the plane that fits them best over the bonds beside it in the same
  /// plane: how the section is bent, however it is divided.
  BondStress stress(const Compound& compound, std::uint32_t bond,
                    std::span<const Displacement> displacements) const;

 private:
  /// How the displacements of two convexes become the stress on their bond.
  struct ElasticBond {
    std::uint32_t a = 0, b = 0;
    double stiffness_Pa_m = 0;  ///< E/d; 0: it has no area.
    double window_m = 0;        ///< Bonds of the same plane are beside it if no farther.
    std::uint64_t plane = 0;
  };
  /// Stress over a bond, linear in the place.
  struct Field {
    double mean_Pa = 0;              ///< Of tension, at the centroid.
    Vec3 slope_Pa_m = Vec3::Zero();  ///< Of tension.
    Vec3 shear_Pa = Vec3::Zero();
    double twist_Pa_m = 0;
  };

  /// What a system is an edit of.
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
  std::vector<std::uint32_t> node_of_convex_;  ///< Spring::kWorld where fixed.
  std::vector<ElasticBond> bonds_;             ///< Per bond.
  std::vector<std::uint32_t> by_plane_;        ///< Bonds sorted by plane, then number.
  std::uint64_t springs_ = 0;
  std::size_t nodes_ = 0;                       ///< Some may stand for nothing.
  bool overlaps_ = false;                       ///< There are ghosts.
  std::shared_ptr<const Multigrid> multigrid_;  ///< Null if nothing can move.
};

}  // namespace sunder::fracture
