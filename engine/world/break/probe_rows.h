// Input of a break probe: bodies, contacts and joints at the start of the step; and the constraint
// rows of contacts and joints at later poses.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/joint.h"
#include "engine/world/actors/actor.h"
#include "engine/world/break/cluster_solve.h"

namespace sunder {

/// A body of the cluster at the start of the step.
struct ProbeBody {
  std::uint32_t key = 0;
  double inverse_mass = 0;                ///< 0 if static or kinematic.
  Mat3 inverse_inertia_W = Mat3::Zero();  ///< About the centre of mass.
  Vec3 position_W = Vec3::Zero();         ///< Centre of mass.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool leans = false;  ///< Supported by something outside the cluster.
  bool breakable = false;
  double least_J = 0;   ///< Work up to this cannot break the body.
  ImpactLimits limits;  ///< An impact that does not exceed these limits cannot break the body.

  /// Returns true if an impact with this work, impulse and speed cannot break the body.
  bool withstands(double work_J, double impulse_Ns, double speed_m_s) const {
    return work_J <= least_J || !limits.exceeded(work_J, impulse_Ns, speed_m_s);
  }
};

/// A contact point of two bodies that touch, or would touch within the step.
struct ProbeContact {
  std::uint32_t a = 0, b = 0;                           ///< Indices of the bodies.
  std::uint32_t shape_a = 0, shape_b = 0;               ///< Opaque to the probe.
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 normal_W = Vec3::UnitY();                        ///< From a to b.
  double separation_m = 0;
  /// True for a rope that may become taut: the arms are those of its ends, the normal points from
  /// b's end to a's, and the separation is the slack. A rope breaks no body, and stays when a body
  /// that it holds breaks.
  bool rope = false;
};

/// A bilateral joint of two bodies, which never fails in the probe: any joint but a rope.
struct ProbeJoint {
  JointKind kind = JointKind::kBall;
  std::uint32_t a = 0, b = 0;                           ///< Indices of the bodies.
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 axis_W = Vec3::UnitZ();                          ///< Axis of a kHinge, fixed to a.
};

/// Pose of a body at a later time of the step.
struct ProbePose {
  Vec3 center_W = Vec3::Zero();
  Quat rotation_W = Quat::Identity();  ///< Since the start of the step.
};
/// Returns the poses of all bodies after the given displacements and rotations.
std::vector<ProbePose> poses_after(const std::vector<ProbeBody>& bodies,
                                   const std::vector<BodyVelocity>& displacements);

/// Returns the row of a contact with the given lever arms.
ContactRow make_row(const std::vector<ProbeBody>& bodies, const ProbeContact& contact,
                    const Vec3& arm_a_W, const Vec3& arm_b_W);
/// Returns the row of a contact at the given poses of the bodies.
ContactRow make_current_row(const std::vector<ProbeBody>& bodies,
                            const std::vector<ProbePose>& poses, const ProbeContact& contact);
/// Returns the rows of all joints at the given poses, the speeds of which must be 0. Joints between
/// two immovable bodies have none.
std::vector<ContactRow> make_joint_rows(const std::vector<ProbeBody>& bodies,
                                        const std::vector<ProbePose>& poses,
                                        const std::vector<ProbeJoint>& joints);

}  // namespace sunder
