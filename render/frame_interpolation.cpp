// Read first: between().
#include "render/frame_interpolation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "engine/base/rotation.h"

namespace sunder::render {
namespace {

constexpr float kMaxDebrisMotion_m = 2;  // in a frame

/// Returns for each body of `after` the index in `before` of the same body, or of the body it broke
/// off. Bodies are sorted by key.
std::vector<std::uint32_t> match_bodies(const Frame& before, const Frame& after) {
  std::vector<std::uint32_t> found(after.bodies.size(), kNoMatch);
  const auto index_of = [&](std::uint64_t key) {
    const auto it = std::ranges::lower_bound(before.bodies, key, {}, &FrameBody::key);
    const bool there = it != before.bodies.end() && it->key == key;
    return there ? static_cast<std::uint32_t>(it - before.bodies.begin()) : kNoMatch;
  };
  for (std::size_t b = 0; b < found.size(); ++b) {
    found[b] = index_of(after.bodies[b].key);
    if (found[b] == kNoMatch) found[b] = index_of(after.bodies[b].previous_key);
  }
  return found;
}

/// Returns true if two debris particles may be the same one. A particle that shrinks is fading and
/// at rest.
bool may_be_same(const FrameDebris& now, const FrameDebris& then) {
  if (now.variant != then.variant || now.material != then.material) return false;
  const float motion_m = (now.position_W - then.position_W).norm();
  return now.radius_m == then.radius_m
             ? motion_m < kMaxDebrisMotion_m
             : now.radius_m < then.radius_m && motion_m < 0.5f * then.radius_m;
}

/// Matches debris by index, then by radius: a removal moves the last particle into the gap.
std::vector<std::uint32_t> match_debris(const std::vector<FrameDebris>& before,
                                        const std::vector<FrameDebris>& after) {
  std::vector<std::uint32_t> found(after.size(), kNoMatch);
  std::vector<std::uint8_t> taken(before.size());
  for (std::uint32_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (!may_be_same(after[i], before[i])) continue;
    found[i] = i;
    taken[i] = 1;
  }
  std::unordered_multimap<float, std::uint32_t> unmatched;  // by radius, which is almost unique
  for (std::uint32_t i = 0; i < before.size(); ++i) {
    if (taken[i] == 0) unmatched.emplace(before[i].radius_m, i);
  }
  for (std::uint32_t i = 0; i < after.size() && !unmatched.empty(); ++i) {
    if (found[i] != kNoMatch) continue;
    auto nearest = unmatched.end();
    float least_m = kMaxDebrisMotion_m;
    const auto [first, last] = unmatched.equal_range(after[i].radius_m);
    for (auto it = first; it != last; ++it) {
      const FrameDebris& then = before[it->second];
      const float motion_m = (after[i].position_W - then.position_W).norm();
      if (!may_be_same(after[i], then) || motion_m >= least_m) continue;
      least_m = motion_m;
      nearest = it;
    }
    if (nearest == unmatched.end()) continue;
    found[i] = nearest->second;
    unmatched.erase(nearest);
  }
  return found;
}

/// Returns a measure of the difference of two puffs, in m: distance, change of radius, and 4 m
/// times 1 − cos(half the angle between them). Puffs drift slowly; their rotations are almost
/// unique.
float difference_of(const FrameDust& now, const FrameDust& then) {
  if (now.material != then.material) return std::numeric_limits<float>::infinity();
  const float rotation_difference =
      1 - std::abs(now.rotation_WD.normalized().dot(then.rotation_WD.normalized()));
  return (now.position_W - then.position_W).norm() + std::abs(now.radius_m - then.radius_m) +
         4 * rotation_difference;
}

/// Matches dust, which keeps its order: of the next kWindow puffs after the last match, the first
/// that differs by at most kSameDifference, else the one that differs least.
std::vector<std::uint32_t> match_dust(const std::vector<FrameDust>& before,
                                      const std::vector<FrameDust>& after) {
  constexpr std::size_t kWindow = 24;
  constexpr float kSameDifference = 0.05f, kMaxDifference = 1;
  std::vector<std::uint32_t> found(after.size(), kNoMatch);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < after.size() && expected < before.size(); ++i) {
    float least = kMaxDifference;
    const std::size_t end = std::min(expected + kWindow, before.size());
    for (std::size_t b = expected; b < end && least > kSameDifference; ++b) {
      const float here = difference_of(after[i], before[b]);
      if (here >= least) continue;
      least = here;
      found[i] = static_cast<std::uint32_t>(b);
    }
    if (found[i] != kNoMatch) expected = found[i] + std::size_t{1};
  }
  return found;
}

/// Returns the rotation vector between rotations, with full turns added to match `expected_W`.
Vec3 turn_between(const Quat& from, const Quat& to, const Vec3& expected_W) {
  const Vec3 turn_W = rotation_vector(to * from.conjugate());
  const double angle = turn_W.norm();
  if (!(angle > 0)) return turn_W;
  const Vec3 axis_W = turn_W / angle;
  const double missing = (expected_W.dot(axis_W) - angle) / (2 * std::numbers::pi);
  return (angle + 2 * std::numbers::pi * std::round(missing)) * axis_W;
}

/// Returns the pose that `body` had while it was part of `before`. Both share the rest frame R.
Pose pose_before(const FrameBody& body, const FrameBody& before) {
  return {before.X_WB * Vec3(body.com_R - before.com_R), before.X_WB.rotation};
}

Pose moved(const Pose& pose, const Vec3& shift_W, const Vec3& turn_W) {
  return {pose.position + shift_W, (rotation_by(turn_W) * pose.rotation).normalized()};
}

/// By key of a body that breaks in the interval: the time of its first break, as a fraction of the
/// interval; breaks are at the start of a step.
using BreakTimes = std::unordered_map<std::uint64_t, double>;

BreakTimes break_times_of(const FrameInterval& interval, double frame_s) {
  BreakTimes break_times;
  for (const BreakEvent& event : interval.after->breaks) {
    const double since = (event.time_s - interval.before->time_s) / frame_s;
    const auto [known, is_first] =
        break_times.emplace(event.parent_key, std::clamp(since, 0.0, 0.99));
    if (!is_first) known->second = std::min(known->second, std::clamp(since, 0.0, 0.99));
  }
  return break_times;
}

/// Returns `pose`, of something fixed to `body`, after the body has moved by its velocities.
Pose extrapolated(const FrameBody& body, const Pose& pose, double for_s) {
  const Vec3 turn_W = for_s * body.angular_velocity_W;
  const Vec3 arm_W = pose.position - body.X_WB.position;
  return {body.X_WB.position + for_s * body.velocity_W + rotation_by(turn_W) * arm_W,
          (rotation_by(turn_W) * pose.rotation).normalized()};
}

/// Returns the pose of a piece: fixed to the whole until `start`, then interpolated to its own.
Pose pose_of_piece(const FrameBody& piece, const FrameBody& whole, double start, double part,
                   double frame_s) {
  const Pose from = pose_before(piece, whole);
  if (part <= start) return extrapolated(whole, from, part * frame_s);
  const Pose parted = extrapolated(whole, from, start * frame_s);
  const double on = (part - start) / (1 - start);
  const Vec3 turn_W = turn_between(parted.rotation, piece.X_WB.rotation,
                                   (1 - start) * frame_s * piece.angular_velocity_W);
  return moved(parted, on * (piece.X_WB.position - parted.position), on * turn_W);
}

void move_bodies(const FrameInterval& interval, const BreakTimes& break_times, double part,
                 double frame_s, Frame& frame) {
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    FrameBody& body = frame.bodies[b];
    const std::uint32_t then = interval.after_match.bodies[b];
    if (then == kNoMatch) {  // a new body, such as a shot
      const double back_s = (part - 1) * frame_s;
      body.X_WB = moved(body.X_WB, back_s * body.velocity_W, back_s * body.angular_velocity_W);
      continue;
    }
    const FrameBody& before = interval.before->bodies[then];
    if (body.key != before.key) {
      const auto broken = break_times.find(before.key);
      const double start = broken == break_times.end() ? 0 : broken->second;
      body.X_WB = pose_of_piece(body, before, start, part, frame_s);
      continue;
    }
    if (body.X_WB == before.X_WB) continue;
    const Pose& from = before.X_WB;
    const Vec3 spin_W = 0.5 * (before.angular_velocity_W + body.angular_velocity_W);
    const Vec3 turn_W = turn_between(from.rotation, body.X_WB.rotation, frame_s * spin_W);
    body.X_WB = moved(from, part * (body.X_WB.position - from.position), part * turn_W);
  }
}

/// Sorts the bodies of a frame by key.
void sort_bodies(Frame& frame) {
  std::vector<std::uint32_t> old_of_new(frame.bodies.size());
  std::iota(old_of_new.begin(), old_of_new.end(), 0u);
  std::ranges::sort(old_of_new, {}, [&](std::uint32_t b) { return frame.bodies[b].key; });
  std::vector<FrameBody> bodies;
  std::vector<std::uint32_t> new_of_old(old_of_new.size());
  for (const std::uint32_t old : old_of_new) {
    new_of_old[old] = static_cast<std::uint32_t>(bodies.size());
    bodies.push_back(frame.bodies[old]);
  }
  for (Instance& instance : frame.instances) instance.body = new_of_old[instance.body];
  frame.bodies = std::move(bodies);
}

/// Adds the removed bodies, extrapolated by their velocities: those without pieces in the next
/// frame whose meshes are not drawn there.
void add_removed_bodies(const FrameInterval& interval, double part, double frame_s, Frame& frame) {
  const Frame& before = *interval.before;
  std::vector<std::uint8_t> is_gone(before.bodies.size(), 1);
  for (const std::uint32_t then : interval.after_match.bodies) {
    if (then != kNoMatch) is_gone[then] = 0;
  }
  std::vector<std::uint8_t> drawn(interval.after->meshes->size());
  for (const Instance& instance : frame.instances) drawn[instance.mesh.value] = 1;
  std::vector<std::uint32_t> place(before.bodies.size(), kNoMatch);
  for (const Instance& instance : before.instances) {
    if (is_gone[instance.body] == 0 || drawn[instance.mesh.value] != 0) continue;
    std::uint32_t& body = place[instance.body];
    if (body == kNoMatch) {
      body = static_cast<std::uint32_t>(frame.bodies.size());
      frame.bodies.push_back(before.bodies[instance.body]);
      FrameBody& flying = frame.bodies.back();
      const double on_s = part * frame_s;
      flying.X_WB = moved(flying.X_WB, on_s * flying.velocity_W, on_s * flying.angular_velocity_W);
    }
    frame.instances.push_back({instance.mesh, body});
  }
  if (frame.bodies.size() > interval.after->bodies.size()) sort_bodies(frame);
}

/// Returns the motion of each particle into the frame beyond; zero if it is not matched there.
template <class Particle>
std::vector<Vec3f> motions_into(const std::vector<Particle>& here,
                                const std::vector<Particle>& beyond,
                                const std::vector<std::uint32_t>& following_match) {
  std::vector<Vec3f> motions(here.size(), Vec3f::Zero());
  for (std::size_t i = 0; i < following_match.size(); ++i) {
    if (following_match[i] == kNoMatch) continue;
    motions[following_match[i]] = beyond[i].position_W - here[following_match[i]].position_W;
  }
  return motions;
}

/// Interpolates rotations of particles, which are quantized and need not have length 1.
Quatf turned(const Quatf& from, const Quatf& to, float part) {
  const float side = from.dot(to) < 0 ? -1.0f : 1.0f;
  const Eigen::Vector4f sum = (1 - part) * from.coeffs() + part * side * to.coeffs();
  return sum.norm() > 0 ? Quatf(sum.normalized()) : to;
}

void scale_visibility(FrameDebris& chip, float by) { chip.radius_m *= by; }
void scale_visibility(FrameDust& puff, float by) { puff.opacity *= by; }
void interpolate_size(FrameDebris& chip, const FrameDebris& then, float part) {
  chip.radius_m = then.radius_m + part * (chip.radius_m - then.radius_m);
}
void interpolate_size(FrameDust& puff, const FrameDust& then, float part) {
  puff.radius_m = then.radius_m + part * (puff.radius_m - then.radius_m);
  puff.opacity = then.opacity + part * (puff.opacity - then.opacity);
}

template <class Particle>
std::vector<Particle> move_particles(const std::vector<Particle>& before,
                                     const std::vector<Particle>& after,
                                     const std::vector<std::uint32_t>& after_match,
                                     const std::vector<Vec3f>& motions, float start, float part) {
  std::vector<Particle> all = after;
  std::vector<std::uint8_t> is_gone(before.size(), 1);
  for (std::size_t i = 0; i < after.size(); ++i) {
    Particle& one = all[i];
    if (after_match[i] == kNoMatch) {
      if (!motions.empty()) one.position_W -= (1 - part) * motions[i];
      scale_visibility(one, std::max(0.0f, (part - start) / (1 - start)));
      continue;
    }
    const Particle& then = before[after_match[i]];
    is_gone[after_match[i]] = 0;
    one.position_W = then.position_W + part * (one.position_W - then.position_W);
    one.rotation_WD = turned(then.rotation_WD, one.rotation_WD, part);
    interpolate_size(one, then, part);
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (is_gone[i] == 0) continue;
    all.push_back(before[i]);
    scale_visibility(all.back(), 1 - part);
  }
  return all;
}

/// Returns the frame with its bodies moved back by their velocities for one frame.
FramePtr moved_back(const Frame& frame) {
  constexpr double kFrame_s = 1.0 / 60;
  auto back = std::make_shared<Frame>(frame);
  back->time_s -= kFrame_s;
  for (FrameBody& body : back->bodies)
    body.X_WB = moved(body.X_WB, -kFrame_s * body.velocity_W, -kFrame_s * body.angular_velocity_W);
  return back;
}

View interpolated(const View& from, const View& to, double part) {
  View view = to;
  view.eye_W = from.eye_W + part * (to.eye_W - from.eye_W);
  view.target_W = from.target_W + part * (to.target_W - from.target_W);
  view.fov_rad = from.fov_rad + part * (to.fov_rad - from.fov_rad);
  return view;
}

}  // namespace

FrameMatch passage(const Frame& before, const Frame& after) {
  return {match_bodies(before, after), match_debris(before.debris, after.debris),
          match_dust(before.dust, after.dust)};
}

FrameInterval up_to(const Frame& after, const Frame* before) {
  const auto borrowed = [](const Frame& frame) { return FramePtr(FramePtr(), &frame); };
  const FramePtr from = before ? borrowed(*before) : moved_back(after);
  return {from, borrowed(after), passage(*from, after)};
}

std::shared_ptr<Frame> between(const FrameInterval& interval, double part) {
  const Frame &before = *interval.before, &after = *interval.after;
  auto frame = std::make_shared<Frame>(after);
  const double frame_s = after.time_s - before.time_s;
  frame->time_s = before.time_s + part * frame_s;
  frame->view = interpolated(before.view, after.view, part);
  frame->breaks.clear();
  frame->recorded_hash = 0;
  const BreakTimes break_times = break_times_of(interval, frame_s);
  double first = break_times.empty() ? 0 : 1;
  for (const auto& [key, start] : break_times) first = std::min(first, start);
  move_bodies(interval, break_times, part, frame_s, *frame);
  add_removed_bodies(interval, part, frame_s, *frame);
  const auto particles = [&](auto list, const std::vector<std::uint32_t>& after_match,
                             const std::vector<std::uint32_t>& following_match) {
    std::vector<Vec3f> motions;
    if (interval.beyond)
      motions = motions_into(after.*list, (*interval.beyond).*list, following_match);
    return move_particles(before.*list, after.*list, after_match, motions,
                          static_cast<float>(first), static_cast<float>(part));
  };
  frame->debris =
      particles(&Frame::debris, interval.after_match.debris, interval.following_match.debris);
  frame->dust = particles(&Frame::dust, interval.after_match.dust, interval.following_match.dust);
  return frame;
}

}  // namespace sunder::render
