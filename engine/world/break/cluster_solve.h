// Contacts of a few bodies solved at once, without rebound or friction: what the break probe makes
// of an impact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

struct BodyVelocity {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// How the motion of two bodies becomes a speed.
struct RowJacobian {
  std::uint32_t a = 0, b = 0;  ///< Bodies, by index.
  Vec3 normal = Vec3::Zero();
  Vec3 angular_a = Vec3::Zero(), angular_b = Vec3::Zero();

  /// At which it closes.
  double speed(const std::vector<BodyVelocity>& v) const {
    return normal.dot(v[a].linear - v[b].linear) + angular_a.dot(v[a].angular) -
           angular_b.dot(v[b].angular);
  }
};

/// A point of contact between two bodies, as a solve sees it; or what a joint does not let them do.
struct ContactRow : RowJacobian {
  bool moves_a = false, moves_b = false;              ///< Or it is fixed.
  Vec3 push_a = Vec3::Zero(), push_b = Vec3::Zero();  ///< Change of velocity per impulse,
  Vec3 spin_a = Vec3::Zero(), spin_b = Vec3::Zero();  ///< and of angular velocity.
  double inverse_mass = 0;                            ///< Of the pair along the normal.
  bool rope = false;                                  ///< Of no account to what may break.

  /// What joints pass on of an impulse, and keep from the two themselves.
  struct PassedOn {
    std::uint32_t body = 0;
    BodyVelocity change;  ///< Per impulse.
  };
  std::vector<PassedOn> passed_on;

  void push(std::vector<BodyVelocity>& v, double impulse_Ns) const {
    v[a].linear -= impulse_Ns * push_a;
    v[a].angular -= impulse_Ns * spin_a;
    v[b].linear += impulse_Ns * push_b;
    v[b].angular += impulse_Ns * spin_b;
    for (const PassedOn& on : passed_on) {
      v[on.body].linear += impulse_Ns * on.change.linear;
      v[on.body].angular += impulse_Ns * on.change.angular;
    }
  }
  /// The change of speed per impulse of another row.
  double coupling(const ContactRow& other) const;
  bool touches(const std::vector<std::uint8_t>& bodies) const {
    return !rope && (bodies[a] || bodies[b]);
  }
};

/// What contacts make of velocities.
struct ClusterMotion {
  std::vector<BodyVelocity> velocities;  ///< Per body.
  std::vector<double> impulses_Ns;       ///< Per closed contact.
  std::uint64_t work = 0;                ///< Visits of a contact.
};

/// Solves those of the `closed` rows that are listed in `in_way` (by place in `closed`), each group
/// that hangs together through moving bodies on its own: exactly, or by sweeps if it is large.
/// `give`: speed per impulse. What closes with less than a thousandth of `fastest_m_s` is at rest.
ClusterMotion solve_cluster(const std::vector<ContactRow>& rows,
                            std::span<const std::uint32_t> closed,
                            std::span<const std::uint32_t> in_way, double give, double fastest_m_s,
                            const std::vector<BodyVelocity>& velocities);

}  // namespace sunder
