// Puts bodies to sleep and wakes them one by one, not by islands: a body at rest may sleep beside a
// moving one.
//
// A sleeping body keeps its mass in the contacts of its neighbours, so that their softness does not
// change, but takes no impulse. A change of the contact forces on it wakes it.
#pragma once

#include <span>
#include <vector>

#include "engine/base/disjoint_sets.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contact_finder.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/joint/joint.h"

namespace sunder::solver {

class Sleep {
 public:
  /// Puts bodies to sleep that have been at rest for longer than they would take to tip. They must
  /// be supported, through loaded contacts or joints and other sleeping bodies, by a body that
  /// cannot move or by a kinematic body at rest. Joined bodies fall asleep together; bodies with a
  /// recent change of load do not. Returns the kinetic energy that this removes, in J.
  double put_to_sleep(const StepContext& step, const Joints& joints, Bodies& bodies,
                      Contacts& contacts);
  /// Wakes sleeping bodies in contact with a moving kinematic body, and the bodies above them.
  void wake_on_kinematic(const Vec3& gravity_W, ContactFinder& finder, Bodies& bodies);
  /// Wakes sleeping bodies whose contact forces the last solve changed; if a body lost support,
  /// also the sleeping bodies above it.
  void wake_by_load(const StepContext& step, ContactFinder& finder, Bodies& bodies);
  /// Must be called before these manifolds are removed. Restarts the time of rest of a body, asleep
  /// or awake, once its removed contacts have carried more than kMaxLostSupport of its weight in
  /// all; wakes that body and all sleeping bodies above it.
  void wake_unsupported(std::span<const ManifoldSlot> manifolds, const Vec3& gravity_W,
                        ContactFinder& finder, Bodies& bodies);
  /// Must be called before a joint is removed. If the joint bears load, wakes its bodies and all
  /// sleeping bodies above them.
  void wake_joined(const Joint& joint, const Vec3& gravity_W, ContactFinder& finder,
                   Bodies& bodies);

 private:
  void update_rest_time(const StepContext& step, Bodies& bodies);
  void anchor_by_joints(const Bodies& bodies, const Joints& joints, DisjointSets& groups);
  void keep_changed_awake(const StepContext& step, const Contacts& contacts, const Bodies& bodies);
  void keep_joined_awake(const Bodies& bodies, const Joints& joints);
  /// Wakes bodies and all sleeping bodies that they support, directly or through sleeping bodies.
  void wake_above(std::vector<BodySlot> lowest, const Vec3& gravity_W, ContactFinder& finder,
                  Bodies& bodies);

  ByBody<std::uint8_t> candidate_, anchored_;
  /// Change of the force on a body, in N, against that at rest.
  ByBody<float> change_N_, support_N_;
};

}  // namespace sunder::solver
