// Plastic joints: yielding of a section.
//
// Divided by the strength of each row alone, the impulses of a substep satisfy across <= 1 - axial²
// (engine/model/section.h): the five transverse ones lie in a ball whose radius depends on the
// axial one. The rows are turned so that one is along the last transverse impulse and is bounded by
// that radius. The other four rows are orthogonal and have the softness that flow along the first
// row gives by the curvature of the ball: several flowing joints would lock if these rows were
// rigid. Axial compression does not flow: an overloaded column bends.
//
// Each pinned row works against its own speed, and each soft row is a damper: flow takes energy,
// however far its direction lags.
#pragma once

#include <span>

#include "solver/rigid/joint/joint_rows.h"

namespace sunder::solver {

using Mat6 = Eigen::Matrix<double, kMostJointRows, kMostJointRows>;

/// Turns the rows and columns of the response of a joint to another, or to itself, for plastic
/// joints.
void turn_rows(const JointWork& of, const JointWork& to, Mat6& response);
/// Turns the target of the rows, and stores the impulses along them as RowBounds::now.
void turn_target(JointWork& work, std::span<double> target);
/// Turns the change of impulses back into the section's rows.
void turn_back(const JointWork& work, std::span<double> change);

/// Aligns the rows with the impulse of this substep, and sets their bounds.
void align_rows(JointWork& work, double h_s);
/// True if the impulse exceeds the strength, since its direction has changed.
bool exceeds_strength(const JointWork& work, double h_s);
/// Stores the speed of flow after a solve.
void record_flow_speed(JointWork& work, const BodyRow* rows);
/// Stores the axial impulse after a solve without correction of errors.
void record_axial(JointWork& work, double h_s);
/// Turns errors of flowing rows into work and a new rest shape, after the bodies moved.
void absorb_flow(JointWork& work, const BodyRow* rows);
/// Excludes flowing rows from the next solve, and removes the bounds of all others.
void fix_flow(JointWork& work);
/// Stores the plastic flow of the step in the joint.
void store_flow(const JointWork& work, Joint& joint);

}  // namespace sunder::solver
