// Elimination of the joints of a few bodies from a contact solve: the contacts are solved with the
// inverse masses that the joints leave to the bodies.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "engine/base/types.h"
#include "solver/impact/cluster_solve.h"

namespace sunder::solver {

/// Joint rows J of bodies with the masses M. M⁻¹ becomes M⁻¹ − M⁻¹Jᵀ(J·M⁻¹·Jᵀ)⁻¹J·M⁻¹, which is
/// exact for trees and closed loops and adds no energy.
class Linkage {
 public:
  /// Linearly dependent rows, as in closed loops of joints, are allowed.
  explicit Linkage(std::vector<ContactRow> rows);

  /// Projects velocities to those that the joints allow, the nearest in kinetic energy.
  void project(std::vector<BodyVelocity>& velocities) const;
  /// Adds the responses of the `bodies` bodies through joints to a contact's row. If the joints do
  /// not let the contact close, the inverse mass of the row becomes 0.
  void add_joint_responses(ContactRow& row, std::size_t bodies) const;

 private:
  /// Returns the joint impulses that change the rows' speeds by `speeds_m_s`.
  Eigen::VectorXd impulses_Ns(const Eigen::VectorXd& speeds_m_s) const;

  std::vector<ContactRow> rows_;
  Eigen::VectorXd unit_;  ///< Per row: scale to a unit diagonal.
  Eigen::LLT<Eigen::MatrixXd> coupling_;
};

}  // namespace sunder::solver
