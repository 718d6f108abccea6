// Bodies fall asleep and wake one by one, not by islands: what rests may sleep beside what moves.
//
// A sleeper keeps its true mass in the contacts of its neighbours, so that those stay as soft as
// they were, but takes no impulse. It sleeps as long as what presses on it stays what it was.
#pragma once

#include <span>
#include <vector>

#include "engine/base/disjoint_sets.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/joint/joint.h"

namespace sunder::solver {

class Sleep {
 public:
  /// Puts bodies to sleep that have been at rest for longer than they would take to tip, and stand
  /// on something, by loaded contacts or joints through other sleepers, that cannot move, or is
  /// kinematic and stands still; what is joined, only together; none whose load has just changed.
  /// The answer is the kinetic energy that was taken away.
  double put_to_sleep(const StepContext& step, const Joints& joints, Bodies& bodies,
                      Contacts& contacts);
  /// Wakes sleepers that something awake is about to hit.
  void wake_hit(const StepContext& step, const Contacts& contacts, Bodies& bodies) const;
  /// Wakes sleepers that touch a kinematic body that is on its way, and what stands on them.
  void wake_carried(const Vec3& gravity_W, const Contacts& contacts, Bodies& bodies);
  /// Wakes sleepers on which the load has changed in the last solve, and what stood on them if it
  /// was their support that went.
  void wake_changed(const StepContext& step, const Contacts& contacts, Bodies& bodies);
  /// Tells bodies at rest, asleep or awake, that these manifolds are about to go. The time of rest
  /// of a body starts anew once those that it lost carried more than kDrift of its weight in all;
  /// the body wakes, and all sleepers that stand on it.
  void wake_left(std::span<const ManifoldSlot> manifolds, const Vec3& gravity_W,
                 const Contacts& contacts, Bodies& bodies);
  /// Wakes the bodies of a joint that bears load and is about to go, and all sleepers that stand on
  /// them.
  void wake_held(const Joint& joint, const Vec3& gravity_W, const Contacts& contacts,
                 Bodies& bodies);
  /// Wakes those of all joints of a body that is about to go.
  void wake_held(std::span<const Joint> joints, BodySlot body, const Vec3& gravity_W,
                 const Contacts& contacts, Bodies& bodies);

 private:
  void note_rest(const StepContext& step, Bodies& bodies);
  void anchor_by_joints(const Bodies& bodies, const Joints& joints, DisjointSets& groups);
  void keep_changed_awake(const StepContext& step, const Contacts& contacts, const Bodies& bodies);
  void keep_joined_awake(const Bodies& bodies, const Joints& joints);
  /// Wakes these and all sleepers that stand on them, by sleepers between.
  void wake_above(std::vector<BodySlot> lowest, const Vec3& gravity_W, const Contacts& contacts,
                  Bodies& bodies);

  ByBody<std::uint8_t> candidate_, anchored_;
  ByBody<float> change_N_, support_N_;  ///< Of the force on a body, from that at rest.
  std::vector<std::uint32_t> first_;    ///< In `above_`, by body.
  std::vector<BodySlot> above_;
};

}  // namespace sunder::solver
