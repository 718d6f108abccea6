// A joint that flows: what its section bears, and along which rows.
//
// In parts of what the section bears of each alone, the impulses of a substep lie in
// across <= 1 - axial² (engine/model/section.h): a ball of five, across, whose radius the axial one
// sets. The section's rows are turned so that one goes along the last impulse across, and is
// bounded by that radius; the other four go beside it, and are soft by what flow along the first
// makes of the ball's curvature: where several joints flow, they would lock if these held. Axial
// compression does not flow: a column that bears too much bends.
//
// Every pinned row works against its own speed, and every soft one is a damper: flow takes energy,
// however far the direction lags behind.
#pragma once

#include <span>

#include "solver/rigid/joint/joint_rows.h"

namespace sunder::solver {

using Mat6 = Eigen::Matrix<double, kMostJointRows, kMostJointRows>;

/// Turns rows and columns of the responses of a joint to another, or to itself, if they are of
/// plastic joints.
void turn_rows(const JointWork& of, const JointWork& to, Mat6& response);
/// Turns what is asked of the rows, and notes the impulses along them.
void turn_asked(JointWork& work, std::span<double> asked);
/// Turns the change of impulses back into the section's rows.
void turn_back(const JointWork& work, std::span<double> change);

/// Turns the rows towards the impulse of this substep, and bounds them.
void aim(JointWork& work, double h_s);
/// Whether the impulse is out of what the section bears, since its direction was another.
bool is_over(const JointWork& work, double h_s);
/// After a solve: how fast it flows.
void note_flow(JointWork& work, const BodyRow* rows);
/// After a solve without correction of errors: what is left across.
void note_axial(JointWork& work, double h_s);
/// When the bodies have moved: what flowed is no error, but work and a new shape at rest.
void follow_flow(JointWork& work, const BodyRow* rows);
/// What flows stays out of what is solved next, and the rest holds whatever it takes.
void hold(JointWork& work);
/// What flowed in the step goes into the joint.
void keep_flow(const JointWork& work, Joint& joint);

}  // namespace sunder::solver
