#include "engine/world/break/break_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/base/rotation.h"

namespace sunder {
namespace {

constexpr int kMostEvents = 24;
// After so many events each is the hardest yet to come, and takes what closes before it along, so
// that a ball behind much debris is not forgotten.
constexpr int kSingleEvents = 12;
constexpr double kFaster = 2;  // than before, no contact closes once others have been solved
// A contact alone that closes with less than this part of the least work is no event of its own.
constexpr double kLeastEvent = 0.1;
// Contacts give a little, against the heaviest body, so that supports share what they bear.
constexpr double kGive = 1e-5;
constexpr double kHangs = 1e-4;  // of gravity: what joints leave no more of does not fall

}  // namespace

BreakProbe::BreakProbe(std::vector<ProbeBody> bodies, std::vector<ProbeContact> contacts,
                       double dt_s, double still_m_s, const Vec3& gravity_W,
                       std::vector<ProbeJoint> joints)
    : bodies_(std::move(bodies)),
      contacts_(std::move(contacts)),
      joints_(std::move(joints)),
      dt_s_(dt_s),
      still_m_s_(still_m_s),
      weight_(bodies_.size()),
      velocities_(bodies_.size()),
      way_(bodies_.size()),
      falls_(bodies_.size(), 0),
      fallen_s_(bodies_.size(), 0),
      pushed_(bodies_.size(), 0),
      undecided_(bodies_.size(), 0) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    velocities_[i] = {bodies_[i].velocity_W, bodies_[i].angular_velocity_W};
  }
  const Linkage linkage(joint_rows(bodies_, places_after(bodies_, way_), joints_));
  for (const ProbeBody& body : bodies_) {
    if (body.breakable) least_J_ = std::min(least_J_, body.least_J);
  }
  rows_.reserve(contacts_.size());
  for (const ProbeContact& c : contacts_) {
    rows_.push_back(make_row(bodies_, c, c.arm_a_W, c.arm_b_W));
    linkage.join(rows_.back(), bodies_.size());
    gaps_m_.push_back(c.separation_m);
  }
  work_ = contacts_.size();
  first_rows_.assign(rows_.begin(), rows_.end());
  speeds_m_s_.resize(rows_.size());
  double least = std::numeric_limits<double>::infinity();
  for (const ProbeBody& body : bodies_) {
    if (body.inverse_mass > 0) least = std::min(least, body.inverse_mass);
  }
  give_ = kGive * least;
  weigh(linkage, gravity_W);
}

/// What gravity does to what touches nothing but joints and taut ropes; what these hold up leans.
void BreakProbe::weigh(const Linkage& linkage, const Vec3& gravity_W) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].inverse_mass > 0) weight_[b].linear = gravity_W;
  }
  linkage.project(weight_);
  std::vector<std::uint32_t> taut, all;
  for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
    if (!rows_[i].rope || !touches(i)) continue;
    all.push_back(static_cast<std::uint32_t>(taut.size()));
    taut.push_back(i);
  }
  weight_ = solve_cluster(rows_, taut, all, give_, gravity_W.norm(), weight_).velocities;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    bodies_[b].leans |= weight_[b].linear.norm() < kHangs * gravity_W.norm();
  }
}

/// What hangs together by touch or joints, and neither stands nor leans on anything, falls.
void BreakProbe::find_falling() {
  DisjointSets groups(bodies_.size());
  std::vector<std::uint8_t> stands(bodies_.size(), 0);
  for (std::size_t b = 0; b < bodies_.size(); ++b) stands[b] = bodies_[b].leans;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactRow& row = rows_[i];
    if (row.inverse_mass <= 0 || !touches(i) || speeds_m_s_[i] < -still_m_s_) continue;
    if (row.moves_a && row.moves_b) {
      groups.join(row.a, row.b);
    } else if (!row.rope) {
      stands[row.moves_a ? row.a : row.b] = 1;
    }
  }
  for (const ProbeJoint& joint : joints_) {
    if (bodies_[joint.a].inverse_mass > 0 && bodies_[joint.b].inverse_mass > 0) {
      groups.join(joint.a, joint.b);
    }
  }
  const std::vector<std::uint32_t> roots = groups.roots();
  for (std::size_t b = 0; b < bodies_.size(); ++b) stands[roots[b]] |= stands[b];
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    falls_[b] = bodies_[b].inverse_mass > 0 && stands[roots[b]] == 0;
  }
}

/// How long until contacts close that may matter; infinite if none does within the step.
double BreakProbe::wait_s() const {
  double wait = std::numeric_limits<double>::infinity(), hardest = 0;
  std::vector<BodyVelocity> fall(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (falls_[b]) fall[b] = weight_[b];
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactRow& row = rows_[i];
    if (row.inverse_mass <= 0) continue;
    const double speed = speeds_m_s_[i], gap = gaps_m_[i];
    double square = speed * speed;  // when it closes
    if (falls_[row.a] || falls_[row.b]) square += 2 * row.speed(fall) * std::max(0.0, gap);
    if (square < still_m_s_ * still_m_s_ || square < 2 * kLeastEvent * least_J_ * row.inverse_mass)
      continue;
    const double closing = speed + std::sqrt(square);  // twice the mean
    if (closing <= 0) continue;
    if (touches(i)) {
      if (events_ == 1) return 0;
    } else if (events_ <= kSingleEvents) {
      wait = std::min(wait, 2 * gap / closing);
    } else if (square > hardest * row.inverse_mass && time_s_ + 2 * gap / closing <= dt_s_) {
      hardest = square / row.inverse_mass;
      wait = 2 * gap / closing;
    }
  }
  return wait;
}

/// All goes on by that time.
void BreakProbe::fall(double time_s) {
  time_s_ += time_s;
  for (std::size_t i = 0; i < way_.size(); ++i) {
    way_[i].linear += time_s * velocities_[i].linear;
    way_[i].angular += time_s * velocities_[i].angular;
    if (!falls_[i]) continue;
    fallen_s_[i] += time_s;
    way_[i].linear += 0.5 * time_s * time_s * weight_[i].linear;
    way_[i].angular += 0.5 * time_s * time_s * weight_[i].angular;
    velocities_[i].linear += time_s * weight_[i].linear;
    velocities_[i].angular += time_s * weight_[i].angular;
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    gaps_m_[i] = contacts_[i].separation_m - first_rows_[i].speed(way_);
  }
}

/// Moves on to when the next contact closes; false if none does within the step.
bool BreakProbe::advance_to_event() {
  if (++events_ > kMostEvents) return false;
  work_ += contacts_.size();
  for (std::size_t i = 0; i < rows_.size(); ++i) speeds_m_s_[i] = rows_[i].speed(velocities_);
  find_falling();
  const double wait = wait_s();
  if (time_s_ + wait > dt_s_) return false;
  fall(wait);
  const std::vector<ProbePlace> places = places_after(bodies_, way_);
  const Linkage linkage(joint_rows(bodies_, places, joints_));
  linkage.project(velocities_);
  closed_.clear();
  fastest_m_s_ = closing_J_ = 0;
  for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
    if (rows_[i].inverse_mass <= 0 || !touches(i)) continue;
    rows_[i] = meet(bodies_, places, contacts_[i]);
    linkage.join(rows_[i], bodies_.size());
    if (rows_[i].inverse_mass <= 0) continue;
    closed_.push_back(i);
    const double speed = std::max(0.0, rows_[i].speed(velocities_));
    fastest_m_s_ = std::max(fastest_m_s_, speed);
    closing_J_ += 0.5 * speed * speed / rows_[i].inverse_mass;
  }
  return true;
}

/// The closed contacts solved, those of `removed` bodies left out.
ClusterMotion BreakProbe::solve(const std::vector<std::uint8_t>& removed) {
  std::vector<std::uint32_t> in_way;  // of closed_
  for (std::uint32_t i = 0; i < closed_.size(); ++i) {
    if (!rows_[closed_[i]].touches(removed)) in_way.push_back(i);
  }
  ClusterMotion solved = solve_cluster(rows_, closed_, in_way, give_, fastest_m_s_, velocities_);
  work_ += solved.work;
  return solved;
}

/// Whether the impulses are enough to load an undecided body beyond its least.
bool BreakProbe::may_load() const {
  std::vector<double> impulses_Ns(bodies_.size(), 0);
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    impulses_Ns[rows_[closed_[i]].a] += with_->impulses_Ns[i];
    impulses_Ns[rows_[closed_[i]].b] += with_->impulses_Ns[i];
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double speed_m_s = kFaster * fastest_m_s_;
    if (undecided_[b] && !bodies_[b].bears(speed_m_s * impulses_Ns[b], impulses_Ns[b], speed_m_s))
      return true;
  }
  return false;
}

std::vector<ProbeLoad> BreakProbe::next(double least_J) {
  for (;;) {
    if (!with_) {  // the last event is over
      if (!advance_to_event()) return {};
      if (closing_J_ < std::max(least_J, least_J_)) continue;
      for (std::size_t b = 0; b < bodies_.size(); ++b) undecided_[b] = bodies_[b].breakable;
      with_ = solve(std::vector<std::uint8_t>(bodies_.size(), 0));
    }
    if (may_load()) {
      loads_ = loads(solve(undecided_));
      if (!loads_.empty()) return loads_;
    }
    note_pushed(*with_);
    velocities_ = with_->velocities;
    with_.reset();
  }
}

void BreakProbe::note_pushed(const ClusterMotion& motion) {
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ContactRow& row = rows_[closed_[i]];
    if (motion.impulses_Ns[i] == 0) continue;
    pushed_[row.a] = pushed_[row.b] = 1;
    for (const ContactRow::PassedOn& on : row.passed_on) pushed_[on.body] = 1;
  }
}

void BreakProbe::hold() {
  for (const ProbeLoad& load : loads_) undecided_[load.body] = 0;
}

/// The kinetic energy of v₁ + s·(v₀ − v₁), v₁ with and v₀ without something in the way, is that of
/// v₁ and as² + bs more. (Were v₁ exact, b would be 0.)
BreakProbe::Release BreakProbe::released(const ClusterMotion& without) const {
  Release release;
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const ContactRow& row = rows_[closed_[i]];
    const double impulse = with_->impulses_Ns[i] - without.impulses_Ns[i];
    const double u0 = row.speed(without.velocities), u1 = row.speed(with_->velocities);
    release.a_J += 0.5 * impulse * (u0 - u1);
    release.b_J += impulse * u1;
  }
  return release;
}

/// The s at which all but `energy_J` is released.
double BreakProbe::Release::share(double energy_J) const {
  const double left = a_J + b_J - energy_J;
  return 2 * left / (b_J + std::sqrt(b_J * b_J + 4 * a_J * left));
}

std::vector<std::uint32_t> BreakProbe::release(std::span<const ProbeBreak> wanted) {
  std::vector<ProbeBreak> kept(wanted.begin(), wanted.end());
  // Those that can least be paid for hold first; then the others may bear less, too.
  while (!kept.empty()) {
    std::vector<std::uint8_t> removed(bodies_.size(), 0);
    double energy = 0;
    for (const ProbeBreak& wish : kept) {
      removed[loads_[wish.load].body] = 1;
      energy += wish.energy_J;
    }
    const ClusterMotion without = solve(removed);
    const Release release = released(without);
    if (release.a_J > 0 && release.a_J + release.b_J > energy) {
      finish(without, release.share(energy));
      std::vector<std::uint32_t> broken;
      for (const ProbeBreak& wish : kept) broken.push_back(wish.load);
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

void BreakProbe::finish(const ClusterMotion& without, double share) {
  note_pushed(*with_);
  note_pushed(without);
  motions_.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    ProbeMotion& motion = motions_[b];
    motion.changed = bodies_[b].inverse_mass > 0 && pushed_[b] != 0;
    if (!motion.changed) continue;
    const BodyVelocity &with = with_->velocities[b], &v0 = without.velocities[b];
    const double fallen_s = fallen_s_[b];
    const BodyVelocity gain{fallen_s * weight_[b].linear, fallen_s * weight_[b].angular};
    motion.velocity_W = with.linear + share * (v0.linear - with.linear) - gain.linear;
    motion.angular_velocity_W = with.angular + share * (v0.angular - with.angular) - gain.angular;
    motion.shift_W = way_[b].linear - time_s_ * motion.velocity_W - 0.5 * fallen_s * gain.linear;
    motion.rotation_W =
        way_[b].angular - time_s_ * motion.angular_velocity_W - 0.5 * fallen_s * gain.angular;
    // Turned back by that, it has the same angular momentum.
    const Mat3 turn(rotation_by(motion.rotation_W));
    const Mat3& inverse_W = bodies_[b].inverse_inertia_W;
    const Vec3 spin_W = inverse_W.inverse() * motion.angular_velocity_W;
    motion.angular_velocity_W = turn * (inverse_W * (turn.transpose() * spin_W));
  }
}

void BreakProbe::pause() {
  motions_.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const ProbeBody& body = bodies_[b];
    motions_[b] = {body.velocity_W + fallen_s_[b] * weight_[b].linear,
                   body.angular_velocity_W + fallen_s_[b] * weight_[b].angular, way_[b].linear,
                   way_[b].angular, body.inverse_mass > 0};
  }
}

}  // namespace sunder
