#include "solver/impact/event_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/base/rotation.h"
#include "solver/impact/impulse_distribution.h"
#include "solver/impact/tuning.h"

namespace sunder::solver {

EventProbe::EventProbe(std::vector<ProbeBody> bodies, std::vector<ProbeContact> contacts,
                       double dt_s, double rest_speed_m_s, const Vec3& gravity_W,
                       std::vector<ProbeJoint> joints, std::uint32_t max_events)
    : bodies_(std::move(bodies)),
      contacts_(std::move(contacts)),
      joints_(std::move(joints)),
      dt_s_(dt_s),
      rest_speed_m_s_(rest_speed_m_s),
      max_events_(max_events),
      gravity_(bodies_.size()),
      velocities_(bodies_.size()),
      displacements_(bodies_.size()),
      falls_(bodies_.size(), 0),
      fall_times_s_(bodies_.size(), 0),
      moved_(bodies_.size(), 0),
      undecided_(bodies_.size(), 0) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    velocities_[i] = {bodies_[i].velocity_W, bodies_[i].angular_velocity_W};
  }
  const Linkage linkage(make_joint_rows(bodies_, poses_after(bodies_, displacements_), joints_));
  for (const ProbeBody& body : bodies_) {
    if (body.breakable) min_safe_work_J_ = std::min(min_safe_work_J_, body.safe_work_J);
  }
  rows_.reserve(contacts_.size());
  for (const ProbeContact& c : contacts_) {
    rows_.push_back(make_row(bodies_, c, c.arm_a_W, c.arm_b_W));
    linkage.add_joint_responses(rows_.back(), bodies_.size());
    gaps_m_.push_back(c.separation_m);
  }
  evaluations_ = contacts_.size();
  first_rows_.assign(rows_.begin(), rows_.end());
  speeds_m_s_.resize(rows_.size());
  double least = std::numeric_limits<double>::infinity();
  for (const ProbeBody& body : bodies_) {
    if (body.inverse_mass > 0) least = std::min(least, body.inverse_mass);
  }
  softness_ = kProbeSoftness * least;
  find_gravity(linkage, gravity_W);
}

/// Finds each body's acceleration by gravity with joints and taut ropes alone. Bodies that these
/// hold up count as supported.
void EventProbe::find_gravity(const Linkage& linkage, const Vec3& gravity_W) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].inverse_mass > 0) gravity_[b].linear = gravity_W;
  }
  linkage.project(gravity_);
  std::vector<std::uint32_t> taut, all;
  for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
    if (!rows_[i].rope || !touches(i)) continue;
    all.push_back(static_cast<std::uint32_t>(taut.size()));
    taut.push_back(i);
  }
  gravity_ = solve_cluster(rows_, taut, all, softness_, gravity_W.norm(), gravity_).velocities;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    bodies_[b].is_supported |= gravity_[b].linear.norm() < kHangingAcceleration * gravity_W.norm();
  }
}

/// Finds the bodies in free fall: those of groups connected by touching contacts or joints in which
/// no body is supported.
void EventProbe::find_falling() {
  DisjointSets groups(bodies_.size());
  std::vector<std::uint8_t> supported(bodies_.size(), 0);
  for (std::size_t b = 0; b < bodies_.size(); ++b) supported[b] = bodies_[b].is_supported;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactRow& row = rows_[i];
    if (row.inverse_mass <= 0 || !touches(i) || speeds_m_s_[i] < -rest_speed_m_s_) continue;
    if (row.moves_a && row.moves_b) {
      groups.join(row.a, row.b);
    } else if (!row.rope) {
      supported[row.moves_a ? row.a : row.b] = 1;
    }
  }
  for (const ProbeJoint& joint : joints_) {
    if (bodies_[joint.a].inverse_mass > 0 && bodies_[joint.b].inverse_mass > 0) {
      groups.join(joint.a, joint.b);
    }
  }
  const std::vector<std::uint32_t> roots = groups.roots();
  for (std::size_t b = 0; b < bodies_.size(); ++b) supported[roots[b]] |= supported[b];
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    falls_[b] = bodies_[b].inverse_mass > 0 && supported[roots[b]] == 0;
  }
}

/// Returns the time until the next event; infinite if there is none.
double EventProbe::time_to_next_event_s() const {
  double wait = std::numeric_limits<double>::infinity(), hardest = 0;
  std::vector<BodyVelocity> acceleration(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (falls_[b]) acceleration[b] = gravity_[b];
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactRow& row = rows_[i];
    if (row.inverse_mass <= 0) continue;
    const double speed = speeds_m_s_[i], gap = gaps_m_[i];
    double square = speed * speed;  // of the closing speed at the time of closing
    if (falls_[row.a] || falls_[row.b]) square += 2 * row.speed(acceleration) * std::max(0.0, gap);
    if (square < rest_speed_m_s_ * rest_speed_m_s_ ||
        square < 2 * kMinEventEnergy * min_safe_work_J_ * row.inverse_mass)
      continue;
    const double closing = speed + std::sqrt(square);  // twice the mean closing speed
    if (closing <= 0) continue;
    if (touches(i)) {
      if (events_ == 1) return 0;
    } else if (events_ <= kOrderedEvents) {
      wait = std::min(wait, 2 * gap / closing);
    } else if (square > hardest * row.inverse_mass && time_s_ + 2 * gap / closing <= dt_s_) {
      hardest = square / row.inverse_mass;
      wait = 2 * gap / closing;
    }
  }
  return wait;
}

/// Advances velocities, displacements and separations by `time_s` without contacts.
void EventProbe::advance_time(double time_s) {
  time_s_ += time_s;
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i].linear += time_s * velocities_[i].linear;
    displacements_[i].angular += time_s * velocities_[i].angular;
    if (!falls_[i]) continue;
    fall_times_s_[i] += time_s;
    displacements_[i].linear += 0.5 * time_s * time_s * gravity_[i].linear;
    displacements_[i].angular += 0.5 * time_s * time_s * gravity_[i].angular;
    velocities_[i].linear += time_s * gravity_[i].linear;
    velocities_[i].angular += time_s * gravity_[i].angular;
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    gaps_m_[i] = contacts_[i].separation_m - first_rows_[i].speed(displacements_);
  }
}

/// Advances to the time at which the next contact closes; returns false if none does in the step,
/// or if it would be one event too many.
bool EventProbe::advance_to_event() {
  const bool is_too_many = ++events_ > max_events_;
  if (!is_too_many) evaluations_ += contacts_.size();
  for (std::size_t i = 0; i < rows_.size(); ++i) speeds_m_s_[i] = rows_[i].speed(velocities_);
  find_falling();
  const double wait = time_to_next_event_s();
  if (time_s_ + wait > dt_s_) return false;
  reached_limit_ = is_too_many;
  if (is_too_many) return false;
  advance_time(wait);
  const std::vector<ProbePose> poses = poses_after(bodies_, displacements_);
  const Linkage linkage(make_joint_rows(bodies_, poses, joints_));
  linkage.project(velocities_);
  closed_.clear();
  fastest_m_s_ = closing_J_ = 0;
  for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
    if (rows_[i].inverse_mass <= 0 || !touches(i)) continue;
    rows_[i] = make_current_row(bodies_, poses, contacts_[i]);
    linkage.add_joint_responses(rows_[i], bodies_.size());
    if (rows_[i].inverse_mass <= 0) continue;
    closed_.push_back(i);
    const double speed = std::max(0.0, rows_[i].speed(velocities_));
    fastest_m_s_ = std::max(fastest_m_s_, speed);
    closing_J_ += 0.5 * speed * speed / rows_[i].inverse_mass;
  }
  return true;
}

/// Solves the closed contacts without those of `removed` bodies.
ClusterMotion EventProbe::solve(const std::vector<std::uint8_t>& removed) {
  std::vector<std::uint32_t> active;  // of closed_
  for (std::uint32_t i = 0; i < closed_.size(); ++i) {
    if (!rows_[closed_[i]].touches(removed)) active.push_back(i);
  }
  ClusterMotion solved =
      solve_cluster(rows_, closed_, active, softness_, fastest_m_s_, velocities_);
  evaluations_ += solved.work;
  return solved;
}

/// Returns true if the impulses may load an undecided body beyond its limits.
bool EventProbe::may_break_any() const {
  std::vector<double> impulses_Ns(bodies_.size(), 0);
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    impulses_Ns[rows_[closed_[i]].a] += with_->impulses_Ns[i];
    impulses_Ns[rows_[closed_[i]].b] += with_->impulses_Ns[i];
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double speed_m_s = kMaxProbeSpeedGain * fastest_m_s_;
    if (undecided_[b] &&
        !bodies_[b].withstands(speed_m_s * impulses_Ns[b], impulses_Ns[b], speed_m_s))
      return true;
  }
  return false;
}

std::vector<ImpactLoad> EventProbe::next(double min_event_J) {
  for (;;) {
    if (!with_) {  // between events
      if (!advance_to_event()) return {};
      if (closing_J_ < std::max(min_event_J, min_safe_work_J_)) continue;
      for (std::size_t b = 0; b < bodies_.size(); ++b) undecided_[b] = bodies_[b].breakable;
      with_ = solve(std::vector<std::uint8_t>(bodies_.size(), 0));
    }
    if (may_break_any()) {
      loads_ = loads(solve(undecided_));
      if (!loads_.empty()) return loads_;
    }
    mark_moved(*with_);
    velocities_ = with_->velocities;
    with_.reset();
  }
}

void EventProbe::mark_moved(const ClusterMotion& motion) {
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ContactRow& row = rows_[closed_[i]];
    if (motion.impulses_Ns[i] == 0) continue;
    moved_[row.a] = moved_[row.b] = 1;
    for (const ContactRow::JointResponse& on : row.joint_responses) moved_[on.body] = 1;
  }
}

void EventProbe::keep_unbroken() {
  for (const ImpactLoad& load : loads_) undecided_[load.body] = 0;
}

/// Returns the kinetic energy of v₁ + s·(v₀ − v₁) less that of v₁, v₁ with and v₀ without the
/// removed bodies in the way, as a·s² + b·s. (With an exact v₁, b would be 0.)
EventProbe::EnergyDifference EventProbe::energy_difference(const ClusterMotion& without) const {
  EnergyDifference difference;
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ContactRow& row = rows_[closed_[i]];
    const double impulse = with_->impulses_Ns[i] - without.impulses_Ns[i];
    const double u0 = row.speed(without.velocities), u1 = row.speed(with_->velocities);
    difference.a_J += 0.5 * impulse * (u0 - u1);
    difference.b_J += impulse * u1;
  }
  return difference;
}

/// Returns the s at which the kinetic energy is that of v₀ less `energy_J`.
double EventProbe::EnergyDifference::blend_factor(double energy_J) const {
  const double left = a_J + b_J - energy_J;
  return 2 * left / (b_J + std::sqrt(b_J * b_J + 4 * a_J * left));
}

std::vector<std::uint32_t> EventProbe::release(std::span<const ProbeBreak> wanted) {
  std::vector<ProbeBreak> kept(wanted.begin(), wanted.end());
  // The body with the least work for its energy is kept whole first, which may reduce the load on
  // the others.
  while (!kept.empty()) {
    std::vector<std::uint8_t> removed(bodies_.size(), 0);
    double energy = 0;
    for (const ProbeBreak& candidate : kept) {
      removed[loads_[candidate.load].body] = 1;
      energy += candidate.energy_J;
    }
    const ClusterMotion without = solve(removed);
    const EnergyDifference difference = energy_difference(without);
    if (difference.a_J > 0 && difference.a_J + difference.b_J > energy) {
      finish(without, difference.blend_factor(energy));
      std::vector<std::uint32_t> broken;
      for (const ProbeBreak& candidate : kept) broken.push_back(candidate.load);
      return broken;
    }
    const auto worst =
        std::max_element(kept.begin(), kept.end(), [&](const ProbeBreak& a, const ProbeBreak& b) {
          return a.energy_J * loads_[b.load].work_J < b.energy_J * loads_[a.load].work_J;
        });
    kept.erase(worst);
  }
  return {};
}

void EventProbe::finish(const ClusterMotion& without, double blend) {
  mark_moved(*with_);
  mark_moved(without);
  motions_.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    ProbeMotion& motion = motions_[b];
    motion.changed = bodies_[b].inverse_mass > 0 && moved_[b] != 0;
    if (!motion.changed) continue;
    const BodyVelocity &with = with_->velocities[b], &v0 = without.velocities[b];
    const double fallen_s = fall_times_s_[b];
    const BodyVelocity gain{fallen_s * gravity_[b].linear, fallen_s * gravity_[b].angular};
    motion.velocity_W = with.linear + blend * (v0.linear - with.linear) - gain.linear;
    motion.angular_velocity_W = with.angular + blend * (v0.angular - with.angular) - gain.angular;
    motion.shift_W =
        displacements_[b].linear - time_s_ * motion.velocity_W - 0.5 * fallen_s * gain.linear;
    motion.rotation_W = displacements_[b].angular - time_s_ * motion.angular_velocity_W -
                        0.5 * fallen_s * gain.angular;
    // Rotating the body back to the start of the step keeps its angular momentum.
    const Mat3 turn(rotation_by(motion.rotation_W));
    const Mat3& inverse_W = bodies_[b].inverse_inertia_W;
    const Vec3 spin_W = inverse_W.inverse() * motion.angular_velocity_W;
    motion.angular_velocity_W = turn * (inverse_W * (turn.transpose() * spin_W));
  }
}

void EventProbe::end_early() {
  motions_.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const ProbeBody& body = bodies_[b];
    motions_[b] = {body.velocity_W + fall_times_s_[b] * gravity_[b].linear,
                   body.angular_velocity_W + fall_times_s_[b] * gravity_[b].angular,
                   displacements_[b].linear, displacements_[b].angular, body.inverse_mass > 0};
  }
}

/// Returns the undecided body to which the work at a contact is attributed: the one with the
/// smaller safe_work_J if both are undecided.
std::uint32_t EventProbe::body_to_load(const ProbeContact& c) const {
  if (!undecided_[c.a]) return c.b;
  if (!undecided_[c.b]) return c.a;
  const ProbeBody &a = bodies_[c.a], &b = bodies_[c.b];
  return std::pair(a.safe_work_J, a.key) < std::pair(b.safe_work_J, b.key) ? c.a : c.b;
}

std::vector<ImpactLoad> EventProbe::loads(const ClusterMotion& without) const {
  std::vector<ImpactLoad> all(bodies_.size());
  std::vector<double> most(bodies_.size(), 0), flux(bodies_.size(), 0),
      most_flux(bodies_.size(), 0);
  for (std::uint32_t b = 0; b < all.size(); ++b) all[b].body = b;
  for (ImpactLoad& load : all) load.direction_W.setZero();
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ProbeContact& c = contacts_[closed_[i]];
    const double impulse = with_->impulses_Ns[i];
    const ContactRow& row = rows_[closed_[i]];
    if (impulse <= 0 || !row.touches(undecided_)) continue;
    const std::uint32_t body = body_to_load(c);
    ImpactLoad& load = all[body];
    load.work_J += 0.5 * impulse * (row.speed(without.velocities) + row.speed(with_->velocities));
    load.impulse_Ns += impulse;
    load.arm_W += impulse * (body == c.b ? c.arm_b_W : c.arm_a_W);
    load.direction_W += (body == c.b ? impulse : -impulse) * c.normal_W;
    const double speed = std::max(0.0, row.speed(without.velocities));
    load.speed_m_s += impulse * speed * speed;
    flux[body] += impulse * speed;
    if (impulse * speed > most_flux[body]) {
      most_flux[body] = impulse * speed;
      load.striker = body == c.b ? c.a : c.b;
      const auto at = [&](std::uint32_t of, const Vec3& arm_W) -> Vec3 {
        const BodyVelocity& v = without.velocities[of];
        return v.linear + v.angular.cross(arm_W);
      };
      load.path_m_s_W = at(c.a, c.arm_a_W) - at(c.b, c.arm_b_W);
      if (body == c.a) load.path_m_s_W *= -1;
    }
    if (impulse <= most[body]) continue;
    most[body] = impulse;
    load.shape = body == c.b ? c.shape_b : c.shape_a;
  }
  for (ImpactLoad& load : all)
    if (flux[load.body] > 0) load.speed_m_s /= flux[load.body];
  std::erase_if(all, [&](const ImpactLoad& load) {
    const ProbeBody& body = bodies_[load.body];
    return body.withstands(load.work_J, load.impulse_Ns, load.speed_m_s) ||
           load.direction_W.squaredNorm() <= 0;
  });
  const double turning_m2_s2 = all.empty() ? 0 : most_turning_m2_s2();
  for (ImpactLoad& load : all) {
    load.arm_W /= load.impulse_Ns;
    load.direction_W.normalize();
    load.time_s = time_s_;
    load.whole_m_s = whole_m_s(load.body, turning_m2_s2);
    add_riders(without, load);
    add_contact_impulses(load);
  }
  return all;
}

double EventProbe::most_turning_m2_s2() const {
  double most = 0;
  for (const std::uint32_t i : closed_) {
    for (const std::uint32_t body : {contacts_[i].a, contacts_[i].b}) {
      if (bodies_[body].inverse_mass <= 0) continue;
      const Vec3& spin_W = velocities_[body].angular;
      most = std::max(most, bodies_[body].inverse_mass *
                                spin_W.dot(bodies_[body].inverse_inertia_W.inverse() * spin_W));
    }
  }
  return most;
}

double EventProbe::whole_m_s(std::uint32_t body, double turning_m2_s2) const {
  double meeting_m2_s2 = 0;
  for (const std::uint32_t i : closed_) {
    for (const std::uint32_t other : {contacts_[i].a, contacts_[i].b}) {
      const Vec3 meeting_m_s = velocities_[other].linear - velocities_[body].linear;
      meeting_m2_s2 = std::max(meeting_m2_s2, meeting_m_s.squaredNorm());
    }
  }
  return std::sqrt(meeting_m2_s2 + turning_m2_s2);
}

void EventProbe::add_riders(const ClusterMotion& without, ImpactLoad& load) const {
  const auto velocity_of = [&](std::uint32_t body) { return without.velocities[body].linear; };
  const Vec3 striker_m_s = velocity_of(load.striker);
  const double most_m_s = kMaxRiderSpeed * (striker_m_s - velocity_of(load.body)).norm();
  std::vector<std::uint32_t> found = {load.striker};
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const ProbeContact& c : contacts_) {
      if (c.rope || (c.a != found[i] && c.b != found[i])) continue;
      const std::uint32_t other = c.a == found[i] ? c.b : c.a;
      if (other == load.body || bodies_[other].inverse_mass <= 0) continue;
      if ((velocity_of(other) - striker_m_s).norm() > most_m_s) continue;
      if (std::ranges::find(found, other) == found.end()) found.push_back(other);
    }
  }
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ProbeContact& c = contacts_[closed_[i]];
    const ContactRow& row = rows_[closed_[i]];
    if (c.a != load.body && c.b != load.body) continue;
    if (std::ranges::find(found, c.a == load.body ? c.b : c.a) == found.end()) continue;
    load.striker_J += 0.5 * with_->impulses_Ns[i] *
                      (row.speed(without.velocities) + row.speed(with_->velocities));
  }
  load.riders.assign(found.begin() + 1, found.end());
  std::ranges::sort(load.riders);
}

/// Adds the impulses of contacts to a load, those of each other body distributed as evenly as their
/// sum and moment allow.
void EventProbe::add_contact_impulses(ImpactLoad& load) const {
  std::map<std::uint32_t, std::vector<ContactPointImpulse>> by_body;
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ProbeContact& c = contacts_[closed_[i]];
    const double impulse = with_->impulses_Ns[i];
    const auto add = [&](std::uint32_t other, std::uint32_t shape, const Vec3& arm_W, double sign) {
      by_body[other].push_back(
          {c.rope ? ProbeImpulse::kNearestShape : shape, arm_W, sign * c.normal_W, impulse});
    };
    if (c.a == load.body) add(c.b, c.shape_a, c.arm_a_W, -1);
    if (c.b == load.body) add(c.a, c.shape_b, c.arm_b_W, 1);
  }
  for (auto& [other, points] : by_body) {
    distribute_evenly(points);
    for (const ContactPointImpulse& point : points) {
      if (point.impulse_Ns <= 0) continue;
      load.impulses.push_back({point.shape, point.arm_W, point.impulse_Ns * point.direction_W});
    }
  }
  add_joint_impulses(load);
}

/// Adds the impulses of joints to a load: the body's change of momentum less the contact impulses,
/// in equal shares for all joints of the body.
void EventProbe::add_joint_impulses(ImpactLoad& load) const {
  const ProbeBody& body = bodies_[load.body];
  std::vector<Vec3> arms_W;
  for (const ProbeJoint& joint : joints_) {
    if (joint.a == load.body) arms_W.push_back(joint.arm_a_W);
    if (joint.b == load.body) arms_W.push_back(joint.arm_b_W);
  }
  if (arms_W.empty() || body.inverse_mass <= 0) return;
  const BodyVelocity &after = with_->velocities[load.body], &before = velocities_[load.body];
  Vec3 linear = (after.linear - before.linear) / body.inverse_mass;
  Vec3 angular = body.inverse_inertia_W.inverse() * (after.angular - before.angular);
  for (const ProbeImpulse& impulse : load.impulses) {
    linear -= impulse.impulse_W;
    angular -= impulse.arm_W.cross(impulse.impulse_W);
  }
  const double share = 1 / static_cast<double>(arms_W.size());
  for (const Vec3& arm_W : arms_W) angular -= share * arm_W.cross(linear);
  for (const Vec3& arm_W : arms_W)
    load.impulses.push_back({ProbeImpulse::kNearestShape, arm_W, share * linear, share * angular});
}

}  // namespace sunder::solver
