// What the convexes of a compound mass_of, and the forces that a load puts on them. Islands that
// nothing anchors are balanced by their own inertia, as free-flying structures are in finite
// elements (inertia relief).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// As a AppliedForce, on a convex of a compound.
struct ConvexLoad {
  std::uint32_t convex = 0;  ///< Index.
  Vec3 force_N = Vec3::Zero();
  Vec3 point_R = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

/// Small displacement of a convex: of its centroid, in metres, and its rotation vector, in radians.
struct Displacement {
  Vec3 shift_R = Vec3::Zero();
  Vec3 rotation_R = Vec3::Zero();
};

/// What forces do on displacements, and what there is to be moved on the way.
struct SwingResponse {
  double work_J = 0;      ///< Σ f·u: twice the energy of springs that the forces have bent.
  double mass_kg_m2 = 0;  ///< Σ m u², but for what moves a loose island as a whole.
};

/// Masses, centroids and inertias per convex, and the islands that nothing anchors.
class ConvexMasses {
 public:
  /// Copies convex c from number `old_of_new[c]` (kNew: from nowhere) of `old`, if there is one,
  /// which is of a compound without ghosts.
  ConvexMasses(const Compound& compound, std::span<const Material> materials,
               const ConvexMasses* old = nullptr, std::span<const std::uint32_t> old_of_new = {});
  static constexpr std::uint32_t kNew = 0xffffffff;

  /// Convexes.
  std::size_t size() const { return centroids_.size(); }
  const Vec3& centroid(std::size_t convex) const { return centroids_[convex]; }
  /// Per convex, whether it does not move: anchored ones, and the heaviest of an island without.
  const std::vector<std::uint8_t>& fixed() const { return fixed_; }
  /// Forces on convexes and torques about their centroids: loads and weight, less what accelerates
  /// a loose island as a whole, which spins at `spin_R` (rad/s).
  void balance(std::span<const ConvexLoad> loads, const Vec3& gravity_R, const Vec3& spin_R,
               std::vector<Vec3>& forces_N, std::vector<Vec3>& torques_Nm) const;
  /// What loads without weight do.
  SwingResponse response(std::span<const ConvexLoad> loads,
                         std::span<const Displacement> displacements) const;
  /// The sizes of all loads, weights and centrifugal forces, summed: what rounding is measured by.
  double applied_N(std::span<const ConvexLoad> loads, const Vec3& gravity_R,
                   const Vec3& spin_R) const;

 private:
  /// Convexes that hang together without an anchor.
  struct Loose {
    std::vector<std::uint32_t> convexes;
    double mass_kg = 0;
    Vec3 com_R = Vec3::Zero();
    Mat3 inverse_inertia = Mat3::Zero();
  };

  void fix(const Compound& compound);
  void add_loose(std::vector<std::uint32_t> convexes);

  std::vector<Vec3> centroids_;  ///< Per convex.
  std::vector<double> masses_kg_;
  std::vector<Mat3> inertias_;
  std::vector<std::uint8_t> fixed_;
  std::vector<Loose> loose_;
};

}  // namespace sunder::fracture
