// The break probe: what a cluster of bodies that touch, or will within the step, would do with and
// without a breakable solid in the way. The difference is the work that the solid has to bear.
//
// Read first: BreakProbe, in the order next(), then hold() or release(). It follows the contacts as
// they close, in order of time, on velocities and displacements of its own: the world is left as it
// is until it takes the result over. Frictionless, without rebound. Joints hold, whatever they
// bear.
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

/// What one contact or joint does to a body.
struct ProbePush {
  static constexpr std::uint32_t kNearest = 0xffffffff;  ///< The shape that is nearest.
  std::uint32_t shape = 0;
  Vec3 arm_W = Vec3::Zero();  ///< From the body's centre of mass.
  Vec3 impulse_W = Vec3::Zero();
  Vec3 angular_W = Vec3::Zero();  ///< Angular impulse besides.
};

/// What a breakable body would have to bear.
struct ProbeLoad {
  std::uint32_t body = 0;            ///< By index.
  std::uint32_t shape = 0;           ///< Where it bears the most.
  Vec3 arm_W = Vec3::Zero();         ///< From the body's centre of mass.
  Vec3 direction_W = Vec3::UnitY();  ///< Into the body.
  double work_J = 0;
  double impulse_Ns = 0;
  /// Closing speed that the contacts that load it would have without it, averaged by the momentum
  /// flux of each.
  double speed_m_s = 0;
  std::uint32_t striker = 0;           ///< Index of the body with the largest share in that.
  std::vector<ProbePush> pushes = {};  ///< All that it feels at once, what it leans on too.
};

/// How a body moves if something breaks: at the start of the step, such that it is where it is, and
/// as fast as it is, at the time of the break.
struct ProbeMotion {
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  Vec3 shift_W = Vec3::Zero();     ///< To add to the position at the start of the step,
  Vec3 rotation_W = Vec3::Zero();  ///< and to its rotation.
  bool changed = false;
};

/// A break that an event can pay for.
struct ProbeBreak {
  std::uint32_t load = 0;  ///< Index in what next() answered.
  double energy_J = 0;     ///< That it takes.
};

class BreakProbe {
 public:
  /// What closes more slowly than `still_m_s` rests; what is as near as that closes in the step
  /// touches. Gravity moves what touches nothing that stands.
  BreakProbe(std::vector<ProbeBody> bodies, std::vector<ProbeContact> contacts, double dt_s,
             double still_m_s, const Vec3& gravity_W = Vec3::Zero(),
             std::vector<ProbeJoint> joints = {});

  /// Runs on to what next loads breakable bodies with more than their least, and with no less than
  /// `least_J` in all; empty at the end of the step. Ordered by body.
  std::vector<ProbeLoad> next(double least_J = 0);
  /// The loaded bodies hold: what is behind them may be loaded through them, at the same time.
  void hold();
  /// Breaks those of `wanted` that the event can pay for, all told, and ends the probe. Takes
  /// exactly their energy: v = v₁ + s·(v₀ − v₁), with v₁ and v₀ the motion with and without them in
  /// the way. The answer is the indices of those that broke; none leaves the probe as it was.
  std::vector<std::uint32_t> release(std::span<const ProbeBreak> wanted);

  /// The event has to wait: all stays as it is but for where bodies are by then. Ends the probe.
  void pause();

  /// How much it has looked at so far: visits of a contact.
  std::uint64_t work() const { return work_; }
  /// After release() or pause(): per body; without meaning where it has not changed.
  const std::vector<ProbeMotion>& motions() const { return motions_; }
  const std::vector<ProbeBody>& bodies() const { return bodies_; }
  const std::vector<ProbeContact>& contacts() const { return contacts_; }
  const std::vector<ProbeJoint>& joints() const { return joints_; }

 private:
  /// The energy between two motions.
  struct Release {
    double a_J = 0, b_J = 0;
    double share(double energy_J) const;
  };

  bool touches(std::size_t contact) const { return gaps_m_[contact] <= still_m_s_ * dt_s_; }
  void weigh(const Linkage& linkage, const Vec3& gravity_W);
  void find_falling();
  double wait_s() const;
  void fall(double time_s);
  bool advance_to_event();
  bool may_load() const;
  ClusterMotion solve(const std::vector<std::uint8_t>& removed);
  std::uint32_t charged(const ProbeContact& c) const;
  std::vector<ProbeLoad> loads(const ClusterMotion& without) const;
  void add_pushes(ProbeLoad& load) const;
  void add_joint_pushes(ProbeLoad& load) const;
  Release released(const ClusterMotion& without) const;
  void note_pushed(const ClusterMotion& motion);
  void finish(const ClusterMotion& without, double share);

  std::vector<ProbeBody> bodies_;
  std::vector<ProbeContact> contacts_;
  std::vector<ProbeJoint> joints_;
  double dt_s_;
  double still_m_s_;
  std::vector<BodyVelocity> weight_;  ///< Acceleration by gravity, as far as joints let it.
  double least_J_ = std::numeric_limits<double>::infinity();  ///< Of the breakable bodies.
  double give_ = 0;                                           ///< Speed per impulse.
  double time_s_ = 0;
  int events_ = 0;
  std::uint64_t work_ = 0;
  std::vector<BodyVelocity> velocities_;  ///< Now.
  std::vector<BodyVelocity> way_;        ///< Displacement and rotation since the start of the step.
  std::vector<std::uint8_t> falls_;      ///< Per body, since the last event.
  std::vector<double> fallen_s_;         ///< Per body: for how long it fell.
  std::vector<std::uint8_t> pushed_;     ///< Per body, by an event.
  std::vector<std::uint32_t> closed_;    ///< Contacts, ascending.
  std::vector<RowJacobian> first_rows_;  ///< Per contact, as the step began,
  std::vector<ContactRow> rows_;         ///< and, if it has closed, as it last did.
  std::vector<double> gaps_m_;           ///< Per contact, now,
  std::vector<double> speeds_m_s_;       ///< and how fast it closed after the last event.
  double fastest_m_s_ = 0;               ///< Of the contacts that closed at this event.
  double closing_J_ = 0;                 ///< No less than what goes into those.
  std::vector<std::uint8_t> undecided_;  ///< Per body, of this event.
  std::vector<ProbeLoad> loads_;         ///< Of this event.
  std::optional<ClusterMotion> with_;    ///< Nothing removed; empty between events.
  std::vector<ProbeMotion> motions_;
};

}  // namespace sunder
