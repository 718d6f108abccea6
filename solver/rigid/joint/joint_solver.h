// Solves joints beside contacts, in the same stages and on the same rows.
//
// Joints that hang together are solved exactly, a group at a time: the equations of a chain form a
// narrow band, which is factored in a time that grows with its length, so that a chain does not
// stretch however heavy what hangs on it. Groups meet contacts, and each other where one would be
// too large, by Gauss-Seidel. Groups of one colour move different bodies and run in parallel.
// Read first: JointSolver::group_joints(), then solve_group() in joint_group.h.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/base/stage_runner.h"
#include "solver/rigid/joint/joint_group.h"

namespace sunder::solver {

class JointSolver {
 public:
  /// Groups the joints that hold something awake, and marks their bodies in `in_contact`.
  void collect(const Bodies& bodies, const Joints& joints, SpanByBody<std::uint8_t> in_contact);
  bool empty() const { return groups_.empty(); }
  /// The groups of each colour: one after another, those of one in parallel.
  const std::vector<StageItems>& colors() const { return colors_; }
  /// The work on group i; `rows` and `at_hand` are those of the step.
  void begin(std::uint32_t i, const StepContext& step, const Bodies& bodies, const Joints& joints,
             const JointStep& at_hand, const BodyRow* rows);
  void warm_start(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    warm_start_group(works(groups_[i]), step, rows);
  }
  void push(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    solve_group(groups_[i], works(groups_[i]), step, true, rows);
  }
  void refresh(std::uint32_t i, const StepContext& step, const BodyRow* rows) {
    refresh_group(groups_[i], works(groups_[i]), step, rows);
  }
  void relax(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    solve_group(groups_[i], works(groups_[i]), step, false, rows);
  }
  /// Once all contacts have had their say in a substep.
  void test(std::uint32_t i, const StepContext& step, BodyRow* rows) {
    test_group(groups_[i], works(groups_[i]), step, rows);
  }
  /// Bodies keep this share of a substep's impulses, by row: so do joints, which then hold again.
  void scale_impulses(std::uint32_t i, const StepContext& step, const float* share_of_row,
                      BodyRow* rows) {
    scale_group(groups_[i], works(groups_[i]), step, share_of_row, rows);
  }
  /// Whether a body hangs in joints, and so does all that it hangs together with, which touches
  /// nothing.
  bool swings_free(BodySlot body) const { return !groups_.empty() && swings_free_[body]; }
  /// As the bodies lie and move when the step is over; what flowed goes into the joints.
  void settle(std::uint32_t i, const StepContext& step, const Bodies& bodies, Joints& joints,
              const JointStep& at_hand, BodyRow* rows);
  /// What hangs together and may move, a joint at a time: a joint to the world twice the same body.
  const std::vector<std::pair<BodySlot, BodySlot>>& joined() const { return joined_; }
  /// Of that, what hangs on something kinematic on its way, which does work on it.
  const std::vector<BodySlot>& carried() const { return carried_; }
  /// Hands impulses back; joints that bore too much go. The answer is the impulse on bodies from
  /// what cannot move.
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
  std::vector<BodySlot> carried_;
  std::vector<std::uint32_t> active_;   ///< Joints that hang together one after another.
  std::vector<std::uint8_t> is_first_;  ///< Of those that hang together; as `active_`.
  std::vector<JointGroup> groups_;      ///< By colour.
  std::vector<StageItems> colors_;
  ByBody<std::uint8_t> swings_free_;
  std::vector<JointWork> works_;  ///< As `active_`.
};

}  // namespace sunder::solver
