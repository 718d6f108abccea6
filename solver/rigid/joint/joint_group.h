// Groups of joints that are solved together by a direct method: banded systems of linear equations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/step_context.h"
#include "solver/rigid/joint/joint_rows.h"

namespace sunder::solver {

struct JointGroup {
  std::uint32_t first = 0, count = 0;  ///< Range of joints.
  std::uint8_t color = 0;
  bool hangs_free = false;  ///< No body of the group is connected to a body in contact.
  bool bounded = false;     ///< An impulse of the group has bounds.
  Envelope matrix;          ///< Responses; factored unless an impulse has bounds.
  PinnedRows pinned;        ///< Used if an impulse has bounds.
  std::vector<std::uint32_t> first_row;  ///< First row of each joint.
  /// First joint of the group that each joint shares a body with.
  std::vector<std::uint32_t> first_shared;
  std::vector<double> softness;  ///< Added to the diagonal, by row.
  std::vector<double> change;    ///< Changes of the impulses, by row.
};

/// Sets the rows for the current poses and velocities.
void begin_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const BodyRow* rows);
/// Applies the impulses of the last step.
void warm_start_group(std::span<JointWork> works, BodyRow* rows);
/// Solves the group once, with or without correction of errors.
void solve_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 bool biased, BodyRow* rows);
/// Updates the rows after the bodies moved.
void refresh_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                   const BodyRow* rows);
/// Breaks the joints whose impulses of the substep exceed their strength.
void break_overloaded_joints(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                             BodyRow* rows);

/// Makes velocities agree with the joints again after the rotation of each body at the end of the
/// step. The stored impulses do not change.
void solve_group_final(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                       BodyRow* rows);

/// Scales the impulses of the substep by the scale of their bodies, by row, and then solves the
/// joints again, which takes energy as any solve of joints does.
void scale_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const float* scale_of_row, BodyRow* rows);

}  // namespace sunder::solver
