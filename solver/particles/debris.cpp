// Read first: advance(), which lists the stages of a step, then move().
#include "solver/particles/debris.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "solver/base/morton_order.h"
#include "solver/base/wide.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kGround = 0xffffffff;  // support index of the ground
constexpr std::size_t kChipsPerBatch = 16;     // chips that query the obstacle grid together
constexpr std::size_t kChipsPerChunk = 32 * kChipsPerBatch;
constexpr std::uint32_t kStepsPerSort = 16;

/// Applies the contact of a sphere with a surface: restitution, Coulomb friction and rolling.
void apply_contact(Vec3f& velocity, Vec3f& angular_velocity, float radius_m, const Vec3f& normal,
                   const Vec3f& surface_velocity) {
  const Vec3f relative = velocity - surface_velocity;
  const float closing_speed = -normal.dot(relative);
  if (closing_speed <= 0) return;
  const float normal_change =
      closing_speed > kMinReboundSpeed_m_s ? (1 + kChipRestitution) * closing_speed : closing_speed;
  const Vec3f slip = relative + closing_speed * normal - radius_m * angular_velocity.cross(normal);
  const float slip_speed = slip.norm();
  // A velocity change of 2/7 of the slip stops it: the effective mass of a sphere at its surface.
  const float stopping_change = slip_speed * (2.0f / 7);
  const float friction = std::min(stopping_change, kChipFriction * normal_change);
  velocity += normal_change * normal;
  if (slip_speed <= 0) return;
  const Vec3f change = slip * (-friction / slip_speed);
  velocity += change;
  angular_velocity += (2.5f / radius_m) * change.cross(normal);
}

bool has_moved(const Pose& before, const Pose& now) {
  const double turned = (before.rotation.coeffs() - now.rotation.coeffs()).norm();
  return (before.position - now.position).norm() > kSupportShift_m || 2 * turned > kSupportTurn_rad;
}

}  // namespace

Debris::Debris(std::uint32_t limit, const Vec3& gravity_W) : limit_(limit), gravity_W_(gravity_W) {}

const char* Debris::wrong_field() const {
  const std::size_t chips = position_W_.size();
  if (chips > limit_) return "limit_";
  if (!have_size(chips, velocity_W_, angular_velocity_W_, rotation_WD_, radius_m_, drawn_radius_m_,
                 slow_s_, variant_, material_, state_, support_, sleep_order_))
    return "position_W_";
  const auto are_below = [](const std::vector<Vec3f>& vectors, float most) {
    return std::ranges::all_of(vectors,
                               [&](const Vec3f& v) { return v.cwiseAbs().maxCoeff() < most; });
  };
  if (!are_below(position_W_, 1e9f)) return "position_W_";
  if (!are_below(velocity_W_, 1e9f)) return "velocity_W_";
  if (!are_below(angular_velocity_W_, 1e9f)) return "angular_velocity_W_";
  const auto is_radius = [](float radius) { return radius >= 0 && radius < 1e6f; };
  if (!std::ranges::all_of(radius_m_, is_radius)) return "radius_m_";
  if (!std::ranges::all_of(drawn_radius_m_, is_radius)) return "drawn_radius_m_";
  // Chips that are gone stay in the order until the lists are made anew.
  if ((lists_valid_ ? order_.size() != chips : order_.size() < chips) ||
      !are_different_below(order_, order_.size()))
    return "order_";
  if (lists_valid_) {
    const auto have_state = [&](const std::vector<std::uint32_t>& list, State state) {
      return list.size() == static_cast<std::size_t>(std::ranges::count(state_, state)) &&
             are_different_below(list, chips) &&
             std::ranges::all_of(list, [&](std::uint32_t chip) { return state_[chip] == state; });
    };
    if (!have_state(awake_, State::kAwake)) return "awake_";
    if (!have_state(asleep_, State::kAsleep)) return "asleep_";
    if (!have_state(fading_, State::kFading)) return "fading_";
  }
  return std::ranges::is_sorted(supports_, {}, &Support::key) ? nullptr : "supports_";
}

void Debris::add(const DebrisBirth& birth) {
  SUNDER_CHECK(birth.radius_m > 0);
  if (room() == 0) {
    ignore();
    return;
  }
  ++counts_.emitted;
  position_W_.push_back(birth.position_W);
  velocity_W_.push_back(birth.velocity_W);
  angular_velocity_W_.push_back(birth.angular_velocity_W);
  rotation_WD_.push_back(birth.rotation_WD);
  radius_m_.push_back(birth.radius_m);
  drawn_radius_m_.push_back(birth.radius_m);
  slow_s_.push_back(0);
  variant_.push_back(birth.variant);
  material_.push_back(birth.material);
  state_.push_back(State::kAwake);
  support_.push_back(kGround);
  sleep_order_.push_back(0);
  order_.push_back(static_cast<std::uint32_t>(position_W_.size() - 1));
  awake_.push_back(order_.back());
}

void Debris::advance(double dt_s, const Obstacles& obstacles) {
  if (position_W_.empty()) return;
  wake_unsupported(obstacles);
  wake_hit(dt_s, obstacles);
  sort();
  if (!lists_valid_) rebuild_lists();
  move_awake(dt_s, obstacles);
  put_to_sleep(dt_s, obstacles);
  fade(static_cast<float>(dt_s));
  if (!lists_valid_) rebuild_lists();
}

/// Sorts the chips by place every few steps, because the neighbours of moving chips change slowly.
void Debris::sort() {
  if (awake_.empty() || steps_++ % kStepsPerSort != 0) return;
  sort_by_morton_code(position_W_, order_);
  lists_valid_ = false;
}

void Debris::wake(std::uint32_t chip) {
  state_[chip] = State::kAwake;
  slow_s_[chip] = 0;
  lists_valid_ = false;
}

/// Wakes the chips whose support was removed, edited or moved. Supports and bodies are both sorted
/// by key, so one pass over both finds these supports.
void Debris::wake_unsupported(const Obstacles& obstacles) {
  std::vector<std::uint32_t> lost;
  auto body = obstacles.bodies.begin();
  for (const Support& support : supports_) {
    while (body != obstacles.bodies.end() && body->key < support.key) ++body;
    const bool gone = body == obstacles.bodies.end() || body->key != support.key;
    if (gone || body->edits != support.edits || has_moved(support.X_WB, body->X_WB))
      lost.push_back(support.key);
  }
  if (lost.empty()) return;
  const auto is_lost = [&](std::uint32_t key) {
    return std::binary_search(lost.begin(), lost.end(), key);
  };
  std::erase_if(supports_, [&](const Support& support) { return is_lost(support.key); });
  for (const std::uint32_t chip : asleep_) {
    if (is_lost(support_[chip])) wake(chip);
  }
}

void Debris::wake_hit(double dt_s, const Obstacles& obstacles) {
  if (asleep_.empty()) return;
  grid_.build(obstacles, dt_s, asleep_box_, ObstacleGrid::Which::kMoving);
  if (grid_.empty()) return;
  std::vector<std::uint8_t> touched(asleep_.size());
  for_chunks(asleep_.size(), kChipsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    ObstacleGrid::Near near;
    std::array<SpherePath, kLanes> paths;
    std::array<std::optional<SphereContact>, kLanes> touches;
    for (std::size_t i = begin; i < end; i += kLanes) {
      const std::size_t count = std::min<std::size_t>(kLanes, end - i);
      for (std::size_t w = 0; w < count; ++w) {
        const Vec3 here = position_W_[asleep_[i + w]].cast<double>();
        paths[w] = {here, here, double{radius_m_[asleep_[i + w]]}, dt_s};
      }
      const std::span some(paths.data(), count);
      grid_.find(some, near);
      grid_.sweep(some, near, touches);
      for (std::size_t w = 0; w < count; ++w) touched[i + w] = touches[w].has_value();
    }
  });
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched[i] && state_[asleep_[i]] == State::kAsleep) wake(asleep_[i]);
  }
}

/// Returns a box that holds the awake chips throughout the next dt_s.
Box Debris::reach_of_awake(double dt_s) {
  chunk_boxes_.assign((awake_.size() + kChipsPerChunk - 1) / kChipsPerChunk, Box());
  const Vec3f fall = (dt_s * gravity_W_).cast<float>();
  const auto step_s = static_cast<float>(dt_s);
  for_chunks(awake_.size(), kChipsPerChunk,
             [&](std::size_t begin, std::size_t end, std::size_t chunk) {
               Vec3f low = Vec3f::Constant(1e30f), high = -low;
               for (std::size_t i = begin; i < end; ++i) {
                 const std::uint32_t chip = awake_[i];
                 const Vec3f path = step_s * (velocity_W_[chip] + fall);
                 const Vec3f reach = path.cwiseAbs().array() + radius_m_[chip];
                 low = low.cwiseMin(position_W_[chip] - reach);
                 high = high.cwiseMax(position_W_[chip] + reach);
               }
               chunk_boxes_[chunk] = {low.cast<double>(), high.cast<double>()};
             });
  Box all;
  for (const Box& reach : chunk_boxes_) all.extend(reach);
  return all;
}

void Debris::move_awake(double dt_s, const Obstacles& obstacles) {
  grid_.build(obstacles, dt_s, reach_of_awake(dt_s), ObstacleGrid::Which::kAll);
  results_.resize(awake_.size());
  for_chunks(awake_.size(), kChipsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    ObstacleGrid::Near near;
    for (std::size_t i = begin; i < end; i += kChipsPerBatch) {
      const std::size_t count = std::min(kChipsPerBatch, end - i);
      const std::span chips(&awake_[i], count);
      for (std::size_t n = i + count; n < std::min(i + count + kChipsPerBatch, end); ++n)
        prefetch_chip(awake_[n]);
      move(chips, {&results_[i], count}, dt_s, obstacles.ground_m, near);
      integrate_rotations(chips, {&results_[i], count}, static_cast<float>(dt_s));
    }
  });
}

/// Prefetches the data of a chip that the next batch reads.
void Debris::prefetch_chip(std::uint32_t chip) const {
  const auto prefetch_each = [chip](const auto&... arrays) {
    (__builtin_prefetch(&arrays[chip]), ...);
  };
  prefetch_each(position_W_, velocity_W_, angular_velocity_W_, rotation_WD_, radius_m_);
}

/// Moves chips: each flies to its first contact, bounces and flies on, at most kMaxChipBounces
/// times.
void Debris::move(std::span<const std::uint32_t> chips, std::span<StepResult> results, double dt_s,
                  double ground_m, ObstacleGrid::Near& near) {
  std::array<SpherePath, kChipsPerBatch> paths;    // remaining paths of the chips that still fly
  std::array<std::size_t, kChipsPerBatch> flying;  // their indices in `chips`
  std::array<std::optional<SphereContact>, kChipsPerBatch> touches;
  const Vec3f fall = (dt_s * gravity_W_).cast<float>();
  for (std::size_t i = 0; i < chips.size(); ++i) {
    velocity_W_[chips[i]] += fall;
    paths[i].from = position_W_[chips[i]].cast<double>();
    paths[i].radius_m = double{radius_m_[chips[i]]};
    paths[i].duration_s = dt_s;
    flying[i] = i;
    results[i] = {};
  }
  std::size_t count = chips.size();
  for (int bounces = 0; count > 0; ++bounces) {
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3f& velocity = velocity_W_[chips[flying[i]]];
      paths[i].to = paths[i].from + paths[i].duration_s * velocity.cast<double>();
    }
    grid_.find(std::span(paths.data(), count), near);
    for (std::size_t i = 0; i < count; i += kLanes) {
      const std::size_t some = std::min<std::size_t>(kLanes, count - i);
      grid_.sweep({&paths[i], some}, near, {&touches[i], some});
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t which = flying[i];
      const bool on =
          advance_to_contact(chips[which], paths[i], touches[i], dt_s, ground_m, results[which]);
      if (!on || bounces == kMaxChipBounces) continue;
      paths[left] = paths[i];
      flying[left++] = which;
    }
    count = left;
  }
}

/// Moves a chip to its first contact or the end of its path. Returns true if time is left.
bool Debris::advance_to_contact(std::uint32_t chip, SpherePath& path,
                                std::optional<SphereContact> touch, double dt_s, double ground_m,
                                StepResult& result) {
  const double lowest = ground_m + path.radius_m;
  const double fall = path.from.y() - path.to.y();
  if (path.to.y() < lowest) {
    const double time = path.from.y() > lowest && fall > 0 ? (path.from.y() - lowest) / fall : 0;
    if (!touch || time < touch->time) {
      touch = SphereContact{time, lowest - path.to.y(), Vec3::UnitY(), Vec3::Zero(), kGround};
    }
  }
  if (!touch) {
    path.from = path.to;
    path.duration_s = 0;
  } else {
    result = {true, touch->velocity_W.norm() < kObstacleRestSpeed_m_s, touch->body};
    if (touch->depth_m > 0 && touch->time <= 0) {
      path.from =
          path.to + std::min(touch->depth_m, kMaxChipPushSpeed_m_s * dt_s) * touch->normal_W;
      path.duration_s = 0;
    } else {
      path.from += touch->time * (path.to - path.from);
      path.duration_s *= 1 - touch->time;
    }
    path.from += kChipContactGap_m * touch->normal_W;
    apply_contact(velocity_W_[chip], angular_velocity_W_[chip], radius_m_[chip],
                  touch->normal_W.cast<float>(), touch->velocity_W.cast<float>());
  }
  path.from.y() = std::max(path.from.y(), lowest);
  position_W_[chip] = path.from.cast<float>();
  return path.duration_s > 0;
}

/// Damps the spin of chips and integrates their rotations; accurate for turns well below a radian.
void Debris::integrate_rotations(std::span<const std::uint32_t> chips,
                                 std::span<const StepResult> results, float dt_s) {
  const float touched = 1 / (1 + dt_s * kContactSpinDamping_1_s);
  const float flying = 1 / (1 + dt_s * kFlightSpinDamping_1_s);
  float q[4][kChipsPerBatch] = {}, w[3][kChipsPerBatch] = {};
  for (std::size_t i = 0; i < chips.size(); ++i) {
    Vec3f& spin = angular_velocity_W_[chips[i]];
    spin *= results[i].touched ? touched : flying;
    for (int axis = 0; axis < 3; ++axis) w[axis][i] = 0.5f * dt_s * spin[axis];
    for (int part = 0; part < 4; ++part) q[part][i] = rotation_WD_[chips[i]].coeffs()[part];
  }
  float scale[kChipsPerBatch];
  for (std::size_t i = 0; i < kChipsPerBatch; ++i) {
    // q += (0, w) q, with the scalar last.
    const float x = q[0][i], y = q[1][i], z = q[2][i], s = q[3][i];
    q[0][i] = x + (w[0][i] * s + w[1][i] * z - w[2][i] * y);
    q[1][i] = y + (w[1][i] * s + w[2][i] * x - w[0][i] * z);
    q[2][i] = z + (w[2][i] * s + w[0][i] * y - w[1][i] * x);
    q[3][i] = s - (w[0][i] * x + w[1][i] * y + w[2][i] * z);
    scale[i] = q[0][i] * q[0][i] + q[1][i] * q[1][i] + q[2][i] * q[2][i] + q[3][i] * q[3][i];
  }
  for (std::size_t i = 0; i < chips.size(); ++i) {
    Quatf& rotation = rotation_WD_[chips[i]];
    const float length = 1 / std::sqrt(scale[i]);
    for (int part = 0; part < 4; ++part) rotation.coeffs()[part] = length * q[part][i];
  }
}

void Debris::put_to_sleep(double dt_s, const Obstacles& obstacles) {
  for (std::size_t i = 0; i < awake_.size(); ++i) {
    const std::uint32_t chip = awake_[i];
    const std::uint32_t body = results_[i].support;
    // A chip at rest touches its support once in several steps if they are short, because of
    // kChipContactGap_m.
    const bool on_support = results_[i].on_still_surface;
    const bool still = (on_support || !results_[i].touched) &&
                       velocity_W_[chip].squaredNorm() < kMaxSleepSpeed_m_s * kMaxSleepSpeed_m_s;
    slow_s_[chip] = still ? slow_s_[chip] + static_cast<float>(dt_s) : 0;
    if (!on_support || slow_s_[chip] < kMinChipRestTime_s) continue;
    state_[chip] = State::kAsleep;
    velocity_W_[chip].setZero();
    angular_velocity_W_[chip].setZero();
    sleep_order_[chip] = next_sleep_order_++;
    support_[chip] = body == kGround ? kGround : obstacles.bodies[body].key;
    if (body != kGround) add_support(obstacles.bodies[body]);
    lists_valid_ = false;
  }
}

void Debris::add_support(const ObstacleBody& body) {
  const auto at = std::lower_bound(supports_.begin(), supports_.end(), body.key,
                                   [](const Support& s, std::uint32_t key) { return s.key < key; });
  if (at == supports_.end() || at->key != body.key)
    supports_.insert(at, {body.key, body.edits, body.X_WB});
}

/// Removes sleeping chips before the limit is reached: the small ones that have slept longest, a
/// chip of twice the radius after four times the time. Removed chips shrink first.
void Debris::fade(float dt_s) {
  const std::size_t kept = limit_ - limit_ / kChipReserve;
  const std::size_t staying = awake_.size() + asleep_.size();
  if (staying > kept && !asleep_.empty()) {
    const std::size_t count = std::min(staying - kept + limit_ / kChipReserve, asleep_.size());
    const auto end = asleep_.begin() + static_cast<std::ptrdiff_t>(count);
    const auto priority = [&](std::uint32_t chip) {
      const auto sleep_age = static_cast<double>(next_sleep_order_ - sleep_order_[chip]);
      return double{radius_m_[chip]} * double{radius_m_[chip]} / sleep_age;
    };
    std::nth_element(asleep_.begin(), end - 1, asleep_.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double of_a = priority(a), of_b = priority(b);
                       return of_a != of_b ? of_a < of_b : sleep_order_[a] < sleep_order_[b];
                     });
    for (auto chip = asleep_.begin(); chip != end; ++chip) state_[*chip] = State::kFading;
    lists_valid_ = false;
  }
  // In descending order, because removal moves the last chip into the gap.
  std::ranges::sort(fading_);
  for (auto chip = fading_.rbegin(); chip != fading_.rend(); ++chip) {
    drawn_radius_m_[*chip] -= radius_m_[*chip] * dt_s / kChipFade_s;
    if (drawn_radius_m_[*chip] <= 0) remove(*chip);
  }
}

void Debris::remove(std::uint32_t chip) {
  const auto drop = [chip](auto&... arrays) {
    ((arrays[chip] = arrays.back(), arrays.pop_back()), ...);
  };
  drop(position_W_, velocity_W_, angular_velocity_W_, rotation_WD_, radius_m_, drawn_radius_m_,
       slow_s_, variant_, material_, state_, support_, sleep_order_);
  ++counts_.gone;
  lists_valid_ = false;
}

/// Rebuilds the lists of awake, sleeping and fading chips.
void Debris::rebuild_lists() {
  awake_.clear();
  asleep_.clear();
  fading_.clear();
  asleep_box_ = Box();
  // Each removal made the last chip number invalid.
  std::erase_if(order_, [&](std::uint32_t chip) { return chip >= state_.size(); });
  for (const std::uint32_t chip : order_) {
    if (state_[chip] == State::kAwake) awake_.push_back(chip);
    if (state_[chip] == State::kFading) fading_.push_back(chip);
    if (state_[chip] != State::kAsleep) continue;
    asleep_.push_back(chip);
    const Vec3 reach = Vec3::Constant(double{radius_m_[chip]});
    const Vec3 at = position_W_[chip].cast<double>();
    asleep_box_.extend(Box{at - reach, at + reach});
  }
  lists_valid_ = true;
}

DebrisView Debris::view() const {
  return {position_W_, rotation_WD_, drawn_radius_m_, variant_, material_};
}

ParticleCounts Debris::counts() const {
  ParticleCounts counts = counts_;
  counts.alive = static_cast<std::uint32_t>(position_W_.size());
  counts.awake = static_cast<std::uint32_t>(awake_.size());
  return counts;
}

}  // namespace sunder::solver
