// The break probe predicts the motion of a cluster of bodies that touch, or will touch within the
// step, with and without a breakable solid in the way. The difference in kinetic energy is the work
// that the solid would have to absorb.
//
// Read first: BreakProbe, in the order next(), then hold() or release(). The probe solves contacts
// in the order in which they close, without friction or restitution, on its own copy of velocities
// and displacements; the caller copies the result to the world. Joints in a probe never fail.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/types.h"
#include "engine/world/break/cluster_solve.h"
#include "engine/world/break/linkage.h"
#include "engine/world/break/probe_rows.h"

namespace sunder {

/// Impulse that one contact or joint applies to a body.
struct ProbeImpulse {
  static constexpr std::uint32_t kNearestShape = 0xffffffff;  ///< The shape nearest to the arm.
  std::uint32_t shape = 0;
  Vec3 arm_W = Vec3::Zero();  ///< From the body's centre of mass.
  Vec3 impulse_W = Vec3::Zero();
  Vec3 angular_W = Vec3::Zero();  ///< Angular impulse in addition to arm × impulse.
};

/// Impact load on a breakable body.
struct ProbeLoad {
  std::uint32_t body = 0;            ///< Index of the loaded body.
  std::uint32_t shape = 0;           ///< Shape with the largest contact impulse.
  Vec3 arm_W = Vec3::Zero();         ///< From the body's centre of mass to the mean contact point.
  Vec3 direction_W = Vec3::UnitY();  ///< Unit, into the body.
  double work_J = 0;
  double impulse_Ns = 0;
  /// Closing speed that the loading contacts would have without the body: a mean weighted by the
  /// momentum flux (impulse × speed) of each contact.
  double speed_m_s = 0;
  std::uint32_t striker = 0;  ///< Index of the other body at the largest momentum flux.
  /// All simultaneous impulses on the body, supports included.
  std::vector<ProbeImpulse> impulses = {};
};

/// Motion of a body at the start of the step that leads to the position and velocity that the body
/// has at the time of the break.
struct ProbeMotion {
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  Vec3 shift_W = Vec3::Zero();     ///< Change of the position at the start of the step.
  Vec3 rotation_W = Vec3::Zero();  ///< Change of the rotation: rotation vector, rad.
  bool changed = false;
};

/// A proposed break of a loaded body.
struct ProbeBreak {
  std::uint32_t load = 0;  ///< Index in the loads that next() returned.
  double energy_J = 0;     ///< Energy that the break takes from the motion.
};

/// Event-driven prediction of the step of a cluster; see the head of this file.
class BreakProbe {
 public:
  /// Contacts that close more slowly than `rest_speed_m_s` count as resting; contacts with a
  /// separation of at most rest_speed_m_s · dt_s count as touching. Gravity accelerates the bodies
  /// that no fixed or supported body supports.
  BreakProbe(std::vector<ProbeBody> bodies, std::vector<ProbeContact> contacts, double dt_s,
             double rest_speed_m_s, const Vec3& gravity_W = Vec3::Zero(),
             std::vector<ProbeJoint> joints = {});

  /// Advances to the next event, with a closing energy of at least `least_J`, that loads breakable
  /// bodies beyond their limits. Returns the loads in order of body; empty at the end of the step.
  std::vector<ProbeLoad> next(double least_J = 0);
  /// Marks the loaded bodies as unbroken in this event, so that next() also returns the bodies that
  /// are loaded through them at the same time.
  void hold();
  /// Breaks those of `wanted` whose total energy the event provides, and ends the probe. Exactly
  /// that energy is taken from the motion: v = v₁ + s·(v₀ − v₁), with v₁ and v₀ the motion with and
  /// without the broken bodies in the way. Returns the load indices of the broken bodies; if there
  /// are none, the probe is unchanged.
  std::vector<std::uint32_t> release(std::span<const ProbeBreak> wanted);

  /// Ends the probe at a deferred event: bodies move to their positions at the time of the event,
  /// with velocities changed by gravity alone.
  void pause();

  /// Work so far, in contact evaluations.
  std::uint64_t work() const { return work_; }
  /// Motion per body after release() or pause(); only entries with `changed` set are valid.
  const std::vector<ProbeMotion>& motions() const { return motions_; }
  const std::vector<ProbeBody>& bodies() const { return bodies_; }
  const std::vector<ProbeContact>& contacts() const { return contacts_; }
  const std::vector<ProbeJoint>& joints() const { return joints_; }

 private:
  /// Kinetic energy of v₁ + s·(v₀ − v₁) relative to v₁, as the polynomial a·s² + b·s.
  struct EnergyDifference {
    double a_J = 0, b_J = 0;
    double blend_factor(double energy_J) const;
  };

  bool touches(std::size_t contact) const { return gaps_m_[contact] <= rest_speed_m_s_ * dt_s_; }
  void find_gravity(const Linkage& linkage, const Vec3& gravity_W);
  void find_falling();
  double time_to_next_event_s() const;
  void advance_time(double time_s);
  bool advance_to_event();
  bool may_break_any() const;
  ClusterMotion solve(const std::vector<std::uint8_t>& removed);
  std::uint32_t body_to_load(const ProbeContact& c) const;
  std::vector<ProbeLoad> loads(const ClusterMotion& without) const;
  void add_contact_impulses(ProbeLoad& load) const;
  void add_joint_impulses(ProbeLoad& load) const;
  EnergyDifference energy_difference(const ClusterMotion& without) const;
  void mark_moved(const ClusterMotion& motion);
  void finish(const ClusterMotion& without, double blend);

  std::vector<ProbeBody> bodies_;
  std::vector<ProbeContact> contacts_;
  std::vector<ProbeJoint> joints_;
  double dt_s_;
  double rest_speed_m_s_;
  std::vector<BodyVelocity> gravity_;  ///< Per body: acceleration by gravity that the joints allow.
  /// Smallest least_J of the breakable bodies.
  double least_J_ = std::numeric_limits<double>::infinity();
  double softness_ = 0;  ///< Contact softness: speed per impulse.
  double time_s_ = 0;
  int events_ = 0;
  std::uint64_t work_ = 0;
  std::vector<BodyVelocity> velocities_;     ///< Per body, at time_s_.
  std::vector<BodyVelocity> displacements_;  ///< Per body, since the start of the step.
  std::vector<std::uint8_t> falls_;  ///< Per body: true if it is in free fall since the last event.
  std::vector<double> fall_times_s_;     ///< Per body: total time in free fall.
  std::vector<std::uint8_t> moved_;      ///< Per body: true if an impulse has acted on it.
  std::vector<std::uint32_t> closed_;    ///< Indices of the closed contacts, ascending.
  std::vector<RowJacobian> first_rows_;  ///< Per contact: at the start of the step.
  std::vector<ContactRow> rows_;         ///< Per contact: at its last closing; else as first_rows_.
  std::vector<double> gaps_m_;           ///< Per contact: separation at time_s_.
  std::vector<double> speeds_m_s_;       ///< Per contact: closing speed after the last event.
  double fastest_m_s_ = 0;               ///< Highest closing speed at this event.
  double closing_J_ = 0;                 ///< Upper bound of the energy of this event.
  std::vector<std::uint8_t> undecided_;  ///< Per body: may still break in this event.
  std::vector<ProbeLoad> loads_;         ///< Loads of this event.
  std::optional<ClusterMotion> with_;  ///< Motion with all bodies in the way; empty between events.
  std::vector<ProbeMotion> motions_;
};

}  // namespace sunder
