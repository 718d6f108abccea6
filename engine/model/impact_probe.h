// Impact probes: the seam by which the world predicts, with the solver's dynamics, the impacts on a
// cluster of bodies within a step before it decides which of them break.
//
// Begin with ImpactProbe, in the order next(), then keep_unbroken() or release(). A probe works on
// its own copy of velocities and displacements; the caller copies the result to the world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/joint.h"

namespace sunder {

/// Energy, impulse and speed that an impact must exceed to break a body.
struct ImpactLimits {
  double by_pattern_J = 0, by_pattern_Ns = 0;  ///< Both are needed for a break by pattern.
  double by_pattern_m_s = 0;                   ///< A break by pattern needs this speed,
  double slow_J = 0;                           ///< or this energy if the impact is slower.
  double by_stress_J = 0, by_stress_Ns = 0;    ///< Both are needed for a break by stress.

  bool exceeded(double energy_J, double impulse_Ns, double speed_m_s) const {
    const bool breaks = energy_J > by_pattern_J && impulse_Ns > by_pattern_Ns &&
                        (speed_m_s > by_pattern_m_s || energy_J > slow_J);
    return breaks || (energy_J > by_stress_J && impulse_Ns > by_stress_Ns);
  }
};

/// A body of the cluster at the start of the step.
struct ProbeBody {
  std::uint32_t key = 0;
  double inverse_mass = 0;                ///< 0 if static or kinematic.
  Mat3 inverse_inertia_W = Mat3::Zero();  ///< About the centre of mass.
  Vec3 position_W = Vec3::Zero();         ///< Centre of mass.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool is_supported = false;  ///< Supported by something outside the cluster.
  bool breakable = false;
  double safe_work_J = 0;  ///< Work up to this cannot break the body.
  ImpactLimits limits;     ///< An impact that does not exceed these limits cannot break the body.

  /// Returns true if an impact with this work, impulse and speed cannot break the body.
  bool withstands(double work_J, double impulse_Ns, double speed_m_s) const {
    return work_J <= safe_work_J || !limits.exceeded(work_J, impulse_Ns, speed_m_s);
  }
};

/// A contact point of two bodies that touch, or would touch within the step.
struct ProbeContact {
  std::uint32_t a = 0, b = 0;                           ///< Indices of the bodies.
  std::uint32_t shape_a = 0, shape_b = 0;               ///< Opaque to the probe.
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 normal_W = Vec3::UnitY();                        ///< From a to b.
  double separation_m = 0;
  /// True for a rope that may become taut: the arms are those of its ends, the normal points from
  /// b's end to a's, and the separation is the slack. A rope breaks no body, and stays when a body
  /// that it holds breaks.
  bool rope = false;
};

/// A bilateral joint of two bodies, which never fails in the probe: any joint but a rope.
struct ProbeJoint {
  JointKind kind = JointKind::kBall;
  std::uint32_t a = 0, b = 0;                           ///< Indices of the bodies.
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  ///< From the centres of mass.
  Vec3 axis_W = Vec3::UnitZ();                          ///< Axis of a kHinge, fixed to a.
};

/// Bodies that touch or will touch within the step, with their contacts and joints.
struct ProbeCluster {
  std::vector<ProbeBody> bodies;
  std::vector<ProbeContact> contacts;
  std::vector<ProbeJoint> joints;
  double dt_s = 0;
  /// Contacts that close more slowly count as resting; contacts with a separation of at most
  /// rest_speed_m_s · dt_s count as touching.
  double rest_speed_m_s = 0;
  /// Accelerates the bodies that no fixed or supported body supports.
  Vec3 gravity_W = Vec3::Zero();
  std::uint32_t max_events = 24;  ///< Number of events after which the probe ends.
};

/// Impulse that one contact or joint applies to a body.
struct ProbeImpulse {
  static constexpr std::uint32_t kNearestShape = 0xffffffff;  ///< The shape nearest to the arm.
  std::uint32_t shape = 0;
  Vec3 arm_W = Vec3::Zero();  ///< From the body's centre of mass.
  Vec3 impulse_W = Vec3::Zero();
  Vec3 angular_W = Vec3::Zero();  ///< Angular impulse in addition to arm × impulse.
};

/// Impact load on a breakable body.
struct ImpactLoad {
  std::uint32_t body = 0;            ///< Index of the loaded body.
  std::uint32_t shape = 0;           ///< Shape with the largest contact impulse.
  Vec3 arm_W = Vec3::Zero();         ///< From the body's centre of mass to the mean contact point.
  Vec3 direction_W = Vec3::UnitY();  ///< Unit, into the body.
  double work_J = 0;
  double striker_J = 0;  ///< Part of the work that the striker and its riders do.
  double impulse_Ns = 0;
  /// Closing speed that the loading contacts would have without the body: a mean weighted by the
  /// momentum flux (impulse × speed) of each contact.
  double speed_m_s = 0;
  /// Largest speed at which the body would meet one of the others with all the energy of its
  /// rotation. A body that falls on one end strikes with the other end faster than this.
  double whole_m_s = 0;
  std::uint32_t striker = 0;  ///< Index of the other body at the largest momentum flux.
  /// Velocity of the striker relative to the body at that contact, if the body were not in the way.
  Vec3 path_m_s_W = Vec3::Zero();
  /// Indices of the bodies that go with the striker as one, ascending: those that it touches,
  /// directly or through others, at about its velocity if the body were not in the way.
  std::vector<std::uint32_t> riders = {};
  double time_s = 0;  ///< Time of the impact since the start of the step.
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

/// Predicts the motion of a cluster within a step with and without a breakable solid in the way.
/// The difference in kinetic energy is the work that the solid would have to absorb. Contacts have
/// neither friction nor restitution; joints never fail. Not shared between threads.
class ImpactProbe {
 public:
  virtual ~ImpactProbe() = default;
  /// Advances to the next event, with a closing energy of at least `min_event_J`, that loads
  /// breakable bodies beyond their limits. Returns the loads in order of body; empty at the end of
  /// the step.
  virtual std::vector<ImpactLoad> next(double min_event_J = 0) = 0;
  /// Marks the loaded bodies as unbroken in this event, so that next() also returns the bodies that
  /// are loaded through them at the same time.
  virtual void keep_unbroken() = 0;
  /// Breaks those of `wanted` whose total energy the event provides, and ends the probe. Exactly
  /// that energy is taken from the motion: v = v₁ + s·(v₀ − v₁), with v₁ and v₀ the motion with and
  /// without the broken bodies in the way. Returns the load indices of the broken bodies; if there
  /// are none, the probe is unchanged.
  virtual std::vector<std::uint32_t> release(std::span<const ProbeBreak> wanted) = 0;
  /// Ends the probe at a deferred event: bodies move to their positions at the time of the event,
  /// with velocities changed by gravity alone.
  virtual void end_early() = 0;
  /// Work so far, in contact evaluations.
  virtual std::uint64_t evaluations() const = 0;
  /// Returns true if next() has ended the probe at `max_events`, before the end of the step.
  virtual bool reached_limit() const = 0;
  /// Motion per body after release() or end_early(); only entries with `changed` set are valid.
  virtual const std::vector<ProbeMotion>& motions() const = 0;
  virtual const std::vector<ProbeBody>& bodies() const = 0;
  virtual const std::vector<ProbeContact>& contacts() const = 0;
  virtual const std::vector<ProbeJoint>& joints() const = 0;
};

}  // namespace sunder
