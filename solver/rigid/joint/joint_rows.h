// What a joint asks of its bodies: up to six rows of a Jacobian and their errors.
//
// As with contacts, angular motion is in root space (Bodies::root_B). Unlike contacts, the rows are
// worked out anew in every substep, from arms that turn with the bodies: a velocity that is put
// right at the new place keeps the energy of a swing (RATTLE, Andersen 1983, in effect).
#pragma once

#include <array>
#include <span>

#include "solver/rigid/body/body_row.h"
#include "solver/rigid/joint/joint.h"
#include "solver/rigid/joint/pinned_rows.h"

namespace sunder::solver {

struct JointRow {
  Vec3f push = Vec3f::Zero();                                  ///< On b; linear.
  Vec3f turn = Vec3f::Zero();                                  ///< On b; of an angular row.
  Vec3f angular_a = Vec3f::Zero(), angular_b = Vec3f::Zero();  ///< Root space.
  double error = 0;                                            ///< m or rad.
  double bend_s2 = 0;  ///< What motion at a constant rate does to the error: its second derivative.
  double softness = 0;  ///< Above 0: no more than a damper, which has so much per impulse.
};

/// An impulse on b and its counterpart on a.
struct JointPush {
  Vec3f push = Vec3f::Zero(), angular_a = Vec3f::Zero(), angular_b = Vec3f::Zero();

  JointPush operator-(const JointPush& o) const {
    return {push - o.push, angular_a - o.angular_a, angular_b - o.angular_b};
  }
};

using Vec6 = Eigen::Matrix<double, kMostJointRows, 1>;

/// What a plastic joint is besides: see plastic.h.
struct PlasticWork {
  Vec6 strength = Vec6::Ones();  ///< Of its section, by row: N and N·m.
  Vec6 mirror = Vec6::Zero();    ///< That turns the rows: of length √2, or none.
  PlasticState state;
  double softness = 0;           ///< What its flow makes of the rows beside.
  Quat turn = Quat::Identity();  ///< That flowed in the step, in the axes of the section,
  Vec3 drawn = Vec3::Zero();     ///< likewise,
  double work_J = 0;             ///< and what it took.
  Vec3 shift_b = Vec3::Zero();   ///< Of the anchor on b, as b lay in these axes as the step began.
};

/// A joint within a step.
struct JointWork {
  std::uint32_t joint = 0;
  JointDesc::Kind kind = JointDesc::Kind::kBall;
  bool broken = false;
  int rows = 0;
  int place_rows = 0;                 ///< The first of them; the others are angular.
  int held_rows = 0;                  ///< Those that hold; what comes after them damps.
  std::int32_t row_a = 0, row_b = 0;  ///< In BodyRow; 0: immovable; less: kinematic.
  float inverse_mass_a = 0, inverse_mass_b = 0;
  Mat3f root_a = Mat3f::Zero(), root_b = Mat3f::Zero();  ///< In W, frozen for the step.
  Vec3 gap = Vec3::Zero();  ///< From anchor a to anchor b when the step began.
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();    ///< From the centres of mass, likewise.
  Vec3 axis_a = Vec3::Zero(), axis_b = Vec3::Zero();  ///< kHinge, likewise.
  Vec3 side_a = Vec3::Zero();                         ///< kHinge: across its axis, fixed to a.
  Mat3 axes = Mat3::Identity();   ///< Of its rows; kPlastic: those of its section, fixed to a.
  Quat twist = Quat::Identity();  ///< kFixed, kPlastic: how far b is turned from where a wants it.
  double reach_m = 0;             ///< Of the smaller body that moves.
  double length_m = 0, breaking_N = 0, breaking_Nm = 0;
  std::array<JointRow, kMostJointRows> row;
  std::array<RowBounds, kMostJointRows> bounds;  ///< Of impulses; kPlastic: along turned rows.
  PlasticWork plastic;
  std::array<double, kMostJointRows> impulse = {};       ///< Of this substep.
  std::array<double, kMostJointRows> kept_impulse = {};  ///< While the end of the step is settled.
  JointImpulse total;                                    ///< Over the step.

  /// What the impulses of this substep would do along rows that have turned since, less what they
  /// did: owed to the next substep, which starts from them.
  JointPush owed;

  /// Speed along row i.
  double speed(int i, const BodyRow* body_rows) const;
  /// Impulses along all rows, as they act on the bodies.
  JointPush sum(std::span<const double> by) const;
  void apply(const JointPush& push, BodyRow* body_rows) const;
};

/// How far a body has turned since the step began.
Quat rotation_of(const Mat3f& root, const BodyRow& row);
/// Where the bodies of a step are: roots in W, and rows of kinematic bodies on their way, none if
/// there are none.
struct JointStep {
  SpanByBody<const Mat3f> root_W;
  SpanByBody<const std::int32_t> kinematic_row;
};
/// A joint as the step begins.
JointWork begin_joint(const Joint& joint, std::uint32_t index, const Bodies& bodies,
                      const JointStep& at);
/// Rows and errors as the bodies lie and move now, for a substep of h_s.
void refresh_rows(JointWork& work, double h_s, const BodyRow* rows);

}  // namespace sunder::solver
