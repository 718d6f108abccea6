// Joints of a few bodies taken out of a solve: what is left of it is contacts, between bodies that
// give as far as their joints let them.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "engine/base/types.h"
#include "engine/world/break/cluster_solve.h"

namespace sunder {

/// With J the rows of joints and M the masses, M⁻¹ becomes M⁻¹ − M⁻¹Jᵀ(J·M⁻¹·Jᵀ)⁻¹J·M⁻¹: exact
/// in trees and in rings, and nothing gains energy by it.
class Linkage {
 public:
  Linkage() = default;
  /// Rows that repeat each other, as a ring has them, are taken as one.
  explicit Linkage(std::vector<ContactRow> rows);

  /// Takes out of velocities what joints do not allow: the nearest that they do, by energy.
  void project(std::vector<BodyVelocity>& velocities) const;
  /// Has the row of a contact move what its bodies are joined to. One that joints leave no way to
  /// close has an inverse mass of 0.
  void join(ContactRow& row, std::size_t bodies) const;

 private:
  /// Impulses that change the speeds of all rows by so much.
  Eigen::VectorXd impulses_Ns(const Eigen::VectorXd& speeds_m_s) const;

  std::vector<ContactRow> rows_;
  Eigen::VectorXd unit_;  ///< Per row: in these all are alike.
  Eigen::LLT<Eigen::MatrixXd> coupling_;
};

}  // namespace sunder
