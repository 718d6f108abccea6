// The solver's impact probe, which solves the contacts of a cluster event by event: the first
// twelve events in the order in which contacts close, later ones by closing energy.
//
// Begin with engine/model/impact_probe.h for what a probe promises, then EventProbe.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/impact_probe.h"
#include "solver/impact/cluster_solve.h"
#include "solver/impact/linkage.h"
#include "solver/impact/probe_rows.h"

namespace sunder::solver {

/// An impact probe that advances from event to event: to the next contacts that close.
class EventProbe final : public ImpactProbe {
 public:
  EventProbe(std::vector<ProbeBody> bodies, std::vector<ProbeContact> contacts, double dt_s,
             double rest_speed_m_s, const Vec3& gravity_W = Vec3::Zero(),
             std::vector<ProbeJoint> joints = {},
             std::uint32_t max_events = ProbeCluster().max_events);

  explicit EventProbe(ProbeCluster cluster)
      : EventProbe(std::move(cluster.bodies), std::move(cluster.contacts), cluster.dt_s,
                   cluster.rest_speed_m_s, cluster.gravity_W, std::move(cluster.joints),
                   cluster.max_events) {}

  std::vector<ImpactLoad> next(double min_event_J = 0) override;
  void keep_unbroken() override;
  std::vector<std::uint32_t> release(std::span<const ProbeBreak> wanted) override;
  void end_early() override;

  std::uint64_t evaluations() const override { return evaluations_; }
  bool reached_limit() const override { return reached_limit_; }
  const std::vector<ProbeMotion>& motions() const override { return motions_; }
  const std::vector<ProbeBody>& bodies() const override { return bodies_; }
  const std::vector<ProbeContact>& contacts() const override { return contacts_; }
  const std::vector<ProbeJoint>& joints() const override { return joints_; }

 private:
  /// Kinetic energy at the velocities v₁ + s·(v₀ − v₁) minus that at v₁, as a·s² + b·s; v₁ and v₀
  /// are the velocities with and without the bodies that break.
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
  std::vector<ImpactLoad> loads(const ClusterMotion& without) const;
  /// Returns the largest energy of rotation per mass of a body with a closed contact, times two.
  double most_turning_m2_s2() const;
  /// Returns ImpactLoad::whole_m_s of a body.
  double whole_m_s(std::uint32_t body, double turning_m2_s2) const;
  /// Adds the bodies that go with a load's striker, and the work of all these.
  void add_riders(const ClusterMotion& without, ImpactLoad& load) const;
  void add_contact_impulses(ImpactLoad& load) const;
  void add_joint_impulses(ImpactLoad& load) const;
  EnergyDifference energy_difference(const ClusterMotion& without) const;
  void mark_moved(const ClusterMotion& motion);
  void finish(const ClusterMotion& without, double blend);

  std::vector<ProbeBody> bodies_;
  std::vector<ProbeContact> contacts_;
  std::vector<ProbeJoint> joints_;
  double dt_s_;
  double rest_speed_m_s_;
  std::uint32_t max_events_;
  std::vector<BodyVelocity> gravity_;  ///< Per body: acceleration by gravity that the joints allow.
  /// Smallest safe_work_J of the breakable bodies.
  double min_safe_work_J_ = std::numeric_limits<double>::infinity();
  double softness_ = 0;  ///< Contact softness: speed per impulse.
  double time_s_ = 0;
  std::uint32_t events_ = 0;
  bool reached_limit_ = false;
  std::uint64_t evaluations_ = 0;
  std::vector<BodyVelocity> velocities_;     ///< Per body, at time_s_.
  std::vector<BodyVelocity> displacements_;  ///< Per body, since the start of the step.
  std::vector<std::uint8_t> falls_;      ///< Per body: true if it falls freely to the next event.
  std::vector<double> fall_times_s_;     ///< Per body: total time in free fall.
  std::vector<std::uint8_t> moved_;      ///< Per body: true if an impulse has acted on it.
  std::vector<std::uint32_t> closed_;    ///< Indices of the closed contacts, ascending.
  std::vector<RowJacobian> first_rows_;  ///< Per contact: at the start of the step.
  std::vector<ContactRow> rows_;         ///< Per contact: at the last event at which it touched.
  std::vector<double> gaps_m_;           ///< Per contact: separation at time_s_.
  std::vector<double> speeds_m_s_;       ///< Per contact: closing speed after the last event.
  double fastest_m_s_ = 0;               ///< Highest closing speed at this event.
  double closing_J_ = 0;                 ///< Upper bound of the energy of this event.
  std::vector<std::uint8_t> undecided_;  ///< Per body: true if it may still break in this event.
  std::vector<ImpactLoad> loads_;        ///< Loads of this event.
  std::optional<ClusterMotion> with_;  ///< Motion with all bodies in the way; empty between events.
  std::vector<ProbeMotion> motions_;
};

inline std::unique_ptr<ImpactProbe> make_event_probe(ProbeCluster cluster) {
  return std::make_unique<EventProbe>(std::move(cluster));
}

}  // namespace sunder::solver
