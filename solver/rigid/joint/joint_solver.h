// Solves joints beside contacts, in the same stages and on the same rows.
//
// Connected joints are solved together by a direct method: the equations of a chain have a narrow
// band, and the time to factor it is linear in its length, so a chain does not stretch whatever its
// load. Groups are coupled to contacts, and to each other where one would be too large, by
// Gauss-Seidel. Groups of one colour move different bodies and run in parallel. Read first:
// JointSolver::group_joints(), then solve_group() in joint_group.h.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/base/stage_runner.h"
#include "solver/rigid/joint/joint_group.h"

namespace sunder::solver {

class JointSolver {
 public:
  /// Groups the joints of awake bodies, and marks these bodies in `in_contact`.
  void collect(const Bodies& bodies, const Joints& joints, SpanByBody<std::uint8_t> in_contact);
  bool empty() const { return groups_.empty(); }
  /// Returns true if connected joints were too many for one group.
  bool was_split() const { return was_split_; }
  /// Groups by colour: colours run one after another, the groups of one in parallel.
  const std::vector<StageItems>& colors() const { return colors_; }
  /// Work on group i; `rows` and `step_bodies` are those of the step.
  void begin(std::uint32_t i, const StepContext& step, const Bodies& bodies, const Joints& joints,
             const JointStep& step_bodies, const BodyRow* rows);
  void warm_start(std::uint32_t i, const StepContext& /*step*/, BodyRow* rows) {
    warm_start_group(works(groups_[i]), rows);
  }
  void solve_biased(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    solve_group(groups_[i], works(groups_[i]), step, true, rows);
  }
  void refresh(std::uint32_t i, const StepContext& step, const BodyRow* rows) {
    refresh_group(groups_[i], works(groups_[i]), step, rows);
  }
  void solve_relaxed(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    solve_group(groups_[i], works(groups_[i]), step, false, rows);
  }
  /// Must be called at the end of a substep, after all sweeps of contacts.
  void break_overloaded(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    break_overloaded_joints(groups_[i], works(groups_[i]), step, rows);
  }
  /// Scales the substep's impulses by the scale of their bodies, by row, and solves the joints
  /// again.
  void scale_impulses(std::uint32_t i, const StepContext& step, const float* scale_of_row,
                      BodyRow* rows) {
    scale_group(groups_[i], works(groups_[i]), step, scale_of_row, rows);
  }
  /// True if a body is held by joints, and no body connected to it touches anything.
  bool hangs_free(BodySlot body) const { return !groups_.empty() && hangs_free_[body]; }
  /// Solves for the poses and velocities at the end of the step; stores plastic flow in the joints.
  void solve_final(std::uint32_t i, const StepContext& step, const Bodies& bodies, Joints& joints,
                   const JointStep& step_bodies, BodyRow* rows);
  /// Pairs of moving bodies, one per joint; a joint to the world has the same body twice.
  const std::vector<std::pair<BodySlot, BodySlot>>& joined() const { return joined_; }
  /// Bodies of these joints that are held by a moving kinematic body, which does work on them.
  const std::vector<BodySlot>& driven() const { return driven_; }
  /// Stores the impulses and removes broken joints. Returns the impulse on bodies from those that
  /// cannot move.
  Vec3 finish(Bodies& bodies, Joints& joints);

 private:
  void mark_free(const Bodies& bodies, SpanByBody<std::uint8_t> in_contact);
  void order_joints(const Bodies& bodies, const Joints& joints);
  void group_joints(const Bodies& bodies, const Joints& joints);
  void color_groups(const Bodies& bodies, const Joints& joints);
  std::span<JointWork> works(const JointGroup& group) {
    return std::span(works_).subspan(group.first, group.count);
  }

  std::vector<std::pair<BodySlot, BodySlot>> joined_;
  std::vector<BodySlot> driven_;
  std::vector<std::uint32_t> active_;   ///< Indices of joints; connected ones are consecutive.
  std::vector<std::uint8_t> is_first_;  ///< 1: first of connected joints; parallel to `active_`.
  std::vector<JointGroup> groups_;      ///< By colour.
  bool was_split_ = false;
  std::vector<StageItems> colors_;
  ByBody<std::uint8_t> hangs_free_;
  std::vector<JointWork> works_;  ///< Parallel to `active_`.
};

}  // namespace sunder::solver
