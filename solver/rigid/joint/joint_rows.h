// The rows of a joint: up to six rows of a Jacobian, and their errors.
//
// As with contacts, angular motion is in root space (Bodies::root_B). Unlike those of contacts, the
// rows are computed in each substep, from arms that turn with the bodies: correcting the velocity
// at the new pose keeps the energy of a swing (RATTLE, Andersen 1983, in effect).
#pragma once

#include <array>
#include <span>

#include "solver/rigid/body/body_row.h"
#include "solver/rigid/joint/joint.h"
#include "solver/rigid/joint/pinned_rows.h"

namespace sunder::solver {

struct JointRow {
  Vec3f push = Vec3f::Zero();  ///< Direction of a linear row, on b.
  Vec3f turn = Vec3f::Zero();  ///< Direction of an angular row, on b.
  Vec3f angular_a = Vec3f::Zero(), angular_b = Vec3f::Zero();  ///< Root space.
  double error = 0;                                            ///< m or rad.
  /// Second derivative of the error at constant angular velocities.
  double error_acceleration = 0;
  double softness = 0;  ///< Above 0: the row is a damper, with this much speed per impulse.
};

/// An impulse on b and its counterpart on a.
struct JointPush {
  Vec3f push = Vec3f::Zero(), angular_a = Vec3f::Zero(), angular_b = Vec3f::Zero();

  JointPush operator-(const JointPush& o) const {
    return {push - o.push, angular_a - o.angular_a, angular_b - o.angular_b};
  }
};

using Vec6 = Eigen::Matrix<double, kMostJointRows, 1>;

/// Data of a plastic joint: see plastic.h.
struct PlasticWork {
  Vec6 strength = Vec6::Ones();  ///< Strength of the section by row, N and N·m.
  Vec6 mirror = Vec6::Zero();  ///< Householder vector that turns the rows: of length √2, or zero.
  PlasticState state;
  double softness = 0;            ///< Softness of the other rows by plastic flow.
  Quat turn = Quat::Identity();   ///< Plastic rotation in the step, in the axes of the section.
  Vec3 extension = Vec3::Zero();  ///< Plastic displacement in the step, in these axes.
  double work_J = 0;              ///< Plastic work in the step.
  /// Displacement of the anchor on b, in these axes as b lay at the start of the step.
  Vec3 shift_b = Vec3::Zero();
};

/// State of a joint within a step.
struct JointWork {
  std::uint32_t joint = 0;
  JointDesc::Kind kind = JointDesc::Kind::kBall;
  bool broken = false;
  int rows = 0;
  int place_rows = 0;                 ///< The first of the rows; the others are angular.
  int held_rows = 0;                  ///< Rows that constrain; those after them damp.
  std::int32_t row_a = 0, row_b = 0;  ///< Index of BodyRow; 0: immovable; below 0: kinematic.
  float inverse_mass_a = 0, inverse_mass_b = 0;
  Mat3f root_a = Mat3f::Zero(), root_b = Mat3f::Zero();  ///< In W, constant within the step.
  Vec3 gap = Vec3::Zero();  ///< From anchor a to anchor b at the start of the step.
  /// From the centres of mass, at the start of the step.
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
  Vec3 axis_a = Vec3::Zero(), axis_b = Vec3::Zero();  ///< kHinge: at the start of the step.
  Vec3 side_a = Vec3::Zero();  ///< kHinge: direction across its axis, fixed to a.
  /// Directions of its rows; kPlastic: axes of the section, fixed to a.
  Mat3 axes = Mat3::Identity();
  /// kFixed, kPlastic: rotation of b from its rest rotation against a.
  Quat twist = Quat::Identity();
  double reach_m = 0;  ///< Reach of the smaller moving body.
  double length_m = 0, breaking_N = 0, breaking_Nm = 0;
  std::array<JointRow, kMostJointRows> row;
  /// Bounds of the impulses; kPlastic: along turned rows.
  std::array<RowBounds, kMostJointRows> bounds;
  PlasticWork plastic;
  std::array<double, kMostJointRows> impulse = {};  ///< By row, of this substep.
  /// Stored while the end of the step is solved.
  std::array<double, kMostJointRows> kept_impulse = {};
  JointImpulse total;  ///< Over the step.

  /// Effect of the substep's impulses along the current rows less that along the old ones; applied
  /// in the next substep, which starts with these impulses.
  JointPush pending;

  /// Returns the speed along row i.
  double speed(int i, const BodyRow* body_rows) const;
  /// Returns the impulses `by` along all rows, as they act on the bodies.
  JointPush sum(std::span<const double> by) const;
  void apply(const JointPush& push, BodyRow* body_rows) const;
};

/// Returns the rotation of a body since the step began.
Quat rotation_of(const Mat3f& root, const BodyRow& row);
/// Bodies of a step: roots in W, and rows of moving kinematic bodies; empty if there are none.
struct JointStep {
  SpanByBody<const Mat3f> root_W;
  SpanByBody<const std::int32_t> kinematic_row;
};
/// Returns the state of a joint at the start of a step.
JointWork begin_joint(const Joint& joint, std::uint32_t index, const Bodies& bodies,
                      const JointStep& at);
/// Updates rows and errors for the current poses and velocities, for a substep of h_s.
void refresh_rows(JointWork& work, double h_s, const BodyRow* rows);

}  // namespace sunder::solver
