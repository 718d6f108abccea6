// Constraint rows of an impact probe's contacts and joints at later poses of the bodies.
#pragma once

#include <vector>

#include "engine/base/types.h"
#include "engine/model/impact_probe.h"
#include "solver/impact/cluster_solve.h"

namespace sunder::solver {

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

}  // namespace sunder::solver
