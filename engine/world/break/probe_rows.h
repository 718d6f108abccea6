// What a break probe is made of: bodies, contacts and joints as the step begins, and what each
// contact and joint asks of the bodies where they are by now.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/joint.h"
#include "engine/world/actors/actor.h"
#include "engine/world/break/cluster_solve.h"

namespace sunder {

/// A body of the cluster, as it moves at the start of the step.
struct ProbeBody {
  std::uint32_t key = 0;
  double inverse_mass = 0;                ///< 0: static or kinematic.
  Mat3 inverse_inertia_W = Mat3::Zero();  ///< About the centre of mass.
  Vec3 position_W = Vec3::Zero();         ///< Of that.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool leans = false;  ///< On what is outside of the cluster.
  bool breakable = false;
  double least_J = 0;   ///< Work below this breaks it in no case,
  ImpactLimits limits;  ///< nor does what does not exceed these.

  bool bears(double work_J, double impulse_Ns, double speed_m_s) const {
    return work_J <= least_J || !limits.exceeded(work_J, impulse_Ns, speed_m_s);
  }
};

/// A point where two bodies touch, or would touch within the step.
struct ProbeContact {
  std::uint32_t a = 0, b = 0;                           ///< Bodies, by index.
  std::uint32_t shape_a = 0, shape_b = 0;               ///< Opaque.
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 normal_W = Vec3::UnitY();                        ///< From a to b.
  double separation_m = 0;
  /// A rope that would run out: the arms are those of its ends, the normal points from b's to a's,
  /// and the separation is its slack. It breaks nothing, and stays when what it holds breaks.
  bool rope = false;
};

/// What holds two bodies together both ways, whatever it bears: any joint but a rope.
struct ProbeJoint {
  JointKind kind = JointKind::kBall;
  std::uint32_t a = 0, b = 0;                           ///< Bodies, by index.
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 axis_W = Vec3::UnitZ();                          ///< kHinge, fixed to a.
};

/// Where a body is by now.
struct ProbePlace {
  Vec3 center_W = Vec3::Zero();
  Quat turn_W = Quat::Identity();  ///< Since the step began.
};
/// Of all bodies, once they have moved and turned by `way`.
std::vector<ProbePlace> places_after(const std::vector<ProbeBody>& bodies,
                                     const std::vector<BodyVelocity>& way);

/// The row of a contact, at the ends of those arms.
ContactRow make_row(const std::vector<ProbeBody>& bodies, const ProbeContact& contact,
                    const Vec3& arm_a_W, const Vec3& arm_b_W);
/// The same where the bodies are by now.
ContactRow meet(const std::vector<ProbeBody>& bodies, const std::vector<ProbePlace>& places,
                const ProbeContact& contact);
/// The rows of joints likewise: what must be 0 of each. None of those between what cannot move.
std::vector<ContactRow> joint_rows(const std::vector<ProbeBody>& bodies,
                                   const std::vector<ProbePlace>& places,
                                   const std::vector<ProbeJoint>& joints);

}  // namespace sunder
