// Joints that are solved together, exactly: the rows of a band of linear equations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/step_context.h"
#include "solver/rigid/joint/joint_rows.h"

namespace sunder::solver {

struct JointGroup {
  std::uint32_t first = 0, count = 0;  ///< Joints.
  std::uint8_t color = 0;
  bool swings_free = false;              ///< It hangs together with nothing that touches anything.
  bool bounded = false;                  ///< Some impulse in it is.
  Envelope matrix;                       ///< Responses; factored, if nothing is bounded.
  PinnedRows pinned;                     ///< If something is.
  std::vector<std::uint32_t> first_row;  ///< Of each joint.
  std::vector<std::uint32_t>
      first_shared;              ///< Of its joints, the first that it shares a body with.
  std::vector<double> softness;  ///< On the diagonal, by row.
  std::vector<double> change;    ///< Scratch.
};

/// Rows for the bodies as they lie and move.
void begin_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const BodyRow* rows);
/// Applies last step's impulses.
void warm_start_group(std::span<JointWork> works, const StepContext& step, BodyRow* rows);
/// One pass, with the correction of errors or without.
void solve_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 bool biased, BodyRow* rows);
/// After bodies moved: new rows.
void refresh_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                   const BodyRow* rows);
/// After a substep: joints that would have had to bear too much bear nothing from here on.
void test_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                BodyRow* rows);

/// After a step: velocities come to agree again, which each body's own spin has put apart. Impulses
/// stay what they were.
void settle_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                  BodyRow* rows);

/// Bodies have kept a share of the substep's impulses, by row: joints keep it too, and then hold
/// again, which takes energy as any joint does.
void scale_group(JointGroup& group, std::span<JointWork> works, const StepContext& step,
                 const float* share_of_row, BodyRow* rows);

}  // namespace sunder::solver
