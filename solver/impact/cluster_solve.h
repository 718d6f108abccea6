// Simultaneous solve of the contacts of a few bodies, without restitution or friction, for the
// impact probe. Read first: solve_cluster().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder::solver {

struct BodyVelocity {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// Jacobian row that maps the velocities of two bodies to a closing speed.
struct RowJacobian {
  std::uint32_t a = 0, b = 0;  ///< Indices of the bodies.
  Vec3 normal = Vec3::Zero();
  Vec3 angular_a = Vec3::Zero(), angular_b = Vec3::Zero();

  /// Closing speed.
  double speed(const std::vector<BodyVelocity>& v) const {
    return normal.dot(v[a].linear - v[b].linear) + angular_a.dot(v[a].angular) -
           angular_b.dot(v[b].angular);
  }
};

/// Constraint row of a contact point between two bodies, or of one degree of freedom that a joint
/// removes.
struct ContactRow : RowJacobian {
  bool moves_a = false, moves_b = false;  ///< False: static or kinematic.
  Vec3 linear_response_a = Vec3::Zero(),
       linear_response_b = Vec3::Zero();  ///< Velocity change per impulse.
  Vec3 angular_response_a = Vec3::Zero(),
       angular_response_b = Vec3::Zero();  ///< Angular velocity change.
  double inverse_mass = 0;                 ///< Inverse effective mass along the row.
  bool rope = false;                       ///< A rope: breaks nothing, never removed.

  /// Velocity change, per impulse of the row, that joints cause in a body (also in a and b).
  struct JointResponse {
    std::uint32_t body = 0;
    BodyVelocity change;  ///< Per impulse.
  };
  std::vector<JointResponse> joint_responses;

  void apply_impulse(std::vector<BodyVelocity>& v, double impulse_Ns) const {
    v[a].linear -= impulse_Ns * linear_response_a;
    v[a].angular -= impulse_Ns * angular_response_a;
    v[b].linear += impulse_Ns * linear_response_b;
    v[b].angular += impulse_Ns * angular_response_b;
    for (const JointResponse& on : joint_responses) {
      v[on.body].linear += impulse_Ns * on.change.linear;
      v[on.body].angular += impulse_Ns * on.change.angular;
    }
  }
  /// Decrease of this row's closing speed per impulse of another row (an entry of J·M⁻¹·Jᵀ).
  double coupling(const ContactRow& other) const;
  bool touches(const std::vector<std::uint8_t>& bodies) const {
    return !rope && (bodies[a] || bodies[b]);
  }
};

/// Result of a solve.
struct ClusterMotion {
  std::vector<BodyVelocity> velocities;  ///< Per body.
  std::vector<double> impulses_Ns;       ///< Normal impulse per closed contact.
  std::uint64_t work = 0;                ///< Contact evaluations.
};

/// Solves the rows listed in `active` (positions in `closed`, which has positions in `rows`). Each
/// group connected through moving bodies is solved separately: exactly, or by sweeps if it is
/// large. `softness`: speed per impulse. Rows that close with less than a hundredth of
/// `fastest_m_s` count as at rest.
ClusterMotion solve_cluster(const std::vector<ContactRow>& rows,
                            std::span<const std::uint32_t> closed,
                            std::span<const std::uint32_t> active, double softness,
                            double fastest_m_s, const std::vector<BodyVelocity>& velocities);

}  // namespace sunder::solver
