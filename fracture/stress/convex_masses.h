// Masses of the convexes of a compound, and the forces on them under a load. Islands without an
// anchor are balanced by their own inertia (inertia relief, as in finite elements).
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// A force on a convex of a compound; see AppliedForce.
struct ConvexLoad {
  std::uint32_t convex = 0;  ///< Index of the convex.
  Vec3 force_N = Vec3::Zero();
  Vec3 point_R = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

/// Small displacement of a convex: shift of its centroid in metres, and rotation vector in radians.
struct Displacement {
  Vec3 shift_R = Vec3::Zero();
  Vec3 rotation_R = Vec3::Zero();
};

/// Work of forces on a displacement, and the modal mass of that displacement.
struct DeflectionResponse {
  /// Σ f·u: twice the strain energy if the forces have caused the displacement.
  double work_J = 0;
  double mass_kg_m2 = 0;  ///< Σ m u², without rigid motion of islands that have no anchor.
};

/// Masses, centroids and inertias of convexes, and the islands without an anchor.
class ConvexMasses {
 public:
  /// Copies the properties of convex c from convex `old_of_new[c]` of `old`, unless that is kNew.
  /// `old` may be null; its compound has no ghosts.
  ConvexMasses() = default;
  ConvexMasses(const Compound& compound, std::span<const Material> materials,
               const ConvexMasses* old = nullptr, std::span<const std::uint32_t> old_of_new = {});
  static constexpr std::uint32_t kNew = 0xffffffff;

  /// Returns the number of convexes.
  std::size_t size() const { return centroids_.size(); }
  const Vec3& centroid(std::size_t convex) const { return centroids_[convex]; }
  /// Per convex: nonzero if it does not move, which is true of anchored convexes and of the
  /// heaviest convex of an island without an anchor.
  const std::vector<std::uint8_t>& fixed() const { return fixed_; }
  /// Sets the forces on convexes and the torques about their centroids: loads and weight, minus the
  /// inertial forces of rigid motion for islands without an anchor, which spin at `spin_R` (rad/s).
  void balance(std::span<const ConvexLoad> loads, const Vec3& gravity_R, const Vec3& spin_R,
               std::vector<Vec3>& forces_N, std::vector<Vec3>& torques_Nm) const;
  /// Returns work and modal mass of displacements under loads without weight.
  DeflectionResponse response(std::span<const ConvexLoad> loads,
                              std::span<const Displacement> displacements) const;
  /// Returns the sum of the magnitudes of all loads, weights and centrifugal forces, to which
  /// rounding errors are relative.
  double applied_N(std::span<const ConvexLoad> loads, const Vec3& gravity_R,
                   const Vec3& spin_R) const;

  static auto fields(auto& self) {
    return std::tie(self.centroids_, self.masses_kg_, self.inertias_, self.fixed_,
                    self.free_islands_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  /// Connected convexes without an anchor.
  struct FreeIsland {
    std::vector<std::uint32_t> convexes;
    double mass_kg = 0;
    Vec3 com_R = Vec3::Zero();
    Mat3 inverse_inertia = Mat3::Zero();
  };

  void find_fixed(const Compound& compound);
  void add_free_island(std::vector<std::uint32_t> convexes);

  std::vector<Vec3> centroids_;  ///< Per convex, as are the next three.
  std::vector<double> masses_kg_;
  std::vector<Mat3> inertias_;
  std::vector<std::uint8_t> fixed_;
  std::vector<FreeIsland> free_islands_;
};

}  // namespace sunder::fracture
