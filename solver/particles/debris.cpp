// Read first: advance(), the list of a step's stages, then move().
#include "solver/particles/debris.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "solver/base/place_order.h"
#include "solver/base/wide.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kGround = 0xffffffff;  // as a support
constexpr std::size_t kBatch = 16;             // chips that look for obstacles together
constexpr std::size_t kChips = 32 * kBatch;
constexpr std::uint32_t kSortEvery = 16;  // moves
constexpr float kFriction = 0.6f;
constexpr float kRestitution = 0.3f;
constexpr float kBounce_m_s = 0.4f;       // slower approaches do not bounce
constexpr double kSkin_m = 2e-4;          // kept between a chip and what it lies on
constexpr double kPushOut_m_s = 2;        // of what starts inside an obstacle
constexpr float kTouchedDamping_s = 150;  // high, so that chips do not roll
constexpr float kFlyingDamping_s = 0.5f;
constexpr float kStill_m_s = 0.1f;
constexpr float kStill_s = 0.25f;
constexpr float kFade_s = 0.75f;
constexpr double kShifted = 1e-3;        // m or rad by which a support has moved
constexpr std::uint32_t kChipRoom = 16;  // one part in so many is kept free for new chips
constexpr int kBounces = 2;              // within one step

/// Contact of a sphere with a surface: restitution, Coulomb friction, rolling.
void bounce(Vec3f& velocity, Vec3f& angular_velocity, float radius_m, const Vec3f& normal,
            const Vec3f& surface_velocity) {
  const Vec3f relative = velocity - surface_velocity;
  const float approach = -normal.dot(relative);
  if (approach <= 0) return;
  const float pushed = approach > kBounce_m_s ? (1 + kRestitution) * approach : approach;
  const Vec3f slip = relative + approach * normal - radius_m * angular_velocity.cross(normal);
  const float slip_speed = slip.norm();
  // 2/7 of the slip stops it: a sphere's effective mass at its surface.
  const float wanted = slip_speed * (2.0f / 7);
  const float friction = std::min(wanted, kFriction * pushed);
  velocity += pushed * normal;
  if (slip_speed <= 0) return;
  const Vec3f change = slip * (-friction / slip_speed);
  velocity += change;
  angular_velocity += (2.5f / radius_m) * change.cross(normal);
}

bool shifted(const Pose& before, const Pose& now) {
  const double turned = (before.rotation.coeffs() - now.rotation.coeffs()).norm();
  return (before.position - now.position).norm() > kShifted || 2 * turned > kShifted;
}

}  // namespace

Debris::Debris(std::uint32_t limit, const Vec3& gravity_W) : limit_(limit), gravity_W_(gravity_W) {}

void Debris::add(const DebrisBirth& birth) {
  SUNDER_CHECK(birth.radius_m > 0);
  if (room() == 0) {
    ignore();
    return;
  }
  ++ledger_.emitted;
  position_W_.push_back(birth.position_W);
  velocity_W_.push_back(birth.velocity_W);
  angular_velocity_W_.push_back(birth.angular_velocity_W);
  rotation_WD_.push_back(birth.rotation_WD);
  radius_m_.push_back(birth.radius_m);
  drawn_radius_m_.push_back(birth.radius_m);
  still_s_.push_back(0);
  variant_.push_back(birth.variant);
  material_.push_back(birth.material);
  state_.push_back(State::kAwake);
  support_.push_back(kGround);
  rest_.push_back(0);
  order_.push_back(static_cast<std::uint32_t>(position_W_.size() - 1));
  awake_.push_back(order_.back());
}

void Debris::advance(double dt_s, const Obstacles& obstacles) {
  if (position_W_.empty()) return;
  wake_unsupported(obstacles);
  wake_touched(dt_s, obstacles);
  sort();
  if (!listed_) list();
  move_awake(dt_s, obstacles);
  put_to_sleep(dt_s, obstacles);
  fade(static_cast<float>(dt_s));
  if (!listed_) list();
}

/// Chips on the move come apart, but not fast.
void Debris::sort() {
  if (awake_.empty() || moves_++ % kSortEvery != 0) return;
  sort_by_place(position_W_, order_);
  listed_ = false;
}

void Debris::wake(std::uint32_t chip) {
  state_[chip] = State::kAwake;
  still_s_[chip] = 0;
  listed_ = false;
}

/// Supports and bodies are both sorted by key: one walk finds which are gone or elsewhere.
void Debris::wake_unsupported(const Obstacles& obstacles) {
  std::vector<std::uint32_t> lost;
  auto body = obstacles.bodies.begin();
  for (const Support& support : supports_) {
    while (body != obstacles.bodies.end() && body->key < support.key) ++body;
    const bool gone = body == obstacles.bodies.end() || body->key != support.key;
    if (gone || body->edits != support.edits || shifted(support.X_WB, body->X_WB))
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

void Debris::wake_touched(double dt_s, const Obstacles& obstacles) {
  if (asleep_.empty()) return;
  movers_.build(obstacles, dt_s, asleep_box_, ObstacleGrid::Which::kMoving);
  if (movers_.empty()) return;
  std::vector<std::uint8_t> touched(asleep_.size());
  for_chunks(asleep_.size(), kChips, [&](std::size_t begin, std::size_t end, std::size_t) {
    ObstacleGrid::Near near;
    std::array<SphereWay, kLanes> ways;
    std::array<std::optional<ObstacleTouch>, kLanes> touches;
    for (std::size_t i = begin; i < end; i += kLanes) {
      const std::size_t count = std::min<std::size_t>(kLanes, end - i);
      for (std::size_t w = 0; w < count; ++w) {
        const Vec3 here = position_W_[asleep_[i + w]].cast<double>();
        ways[w] = {here, here, double{radius_m_[asleep_[i + w]]}, dt_s};
      }
      const std::span some(ways.data(), count);
      movers_.find(some, near);
      movers_.sweep(some, near, touches);
      for (std::size_t w = 0; w < count; ++w) touched[i + w] = touches[w].has_value();
    }
  });
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched[i] && state_[asleep_[i]] == State::kAsleep) wake(asleep_[i]);
  }
}

/// What those awake may come to in the next dt_s.
Box Debris::reach_of_awake(double dt_s) {
  reaches_.assign((awake_.size() + kChips - 1) / kChips, Box());
  const Vec3f fall = (dt_s * gravity_W_).cast<float>();
  const auto step_s = static_cast<float>(dt_s);
  for_chunks(awake_.size(), kChips, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    Vec3f low = Vec3f::Constant(1e30f), high = -low;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t chip = awake_[i];
      const Vec3f way = step_s * (velocity_W_[chip] + fall);
      const Vec3f reach = way.cwiseAbs().array() + radius_m_[chip];
      low = low.cwiseMin(position_W_[chip] - reach);
      high = high.cwiseMax(position_W_[chip] + reach);
    }
    reaches_[chunk] = {low.cast<double>(), high.cast<double>()};
  });
  Box all;
  for (const Box& reach : reaches_) all.extend(reach);
  return all;
}

void Debris::move_awake(double dt_s, const Obstacles& obstacles) {
  grid_.build(obstacles, dt_s, reach_of_awake(dt_s), ObstacleGrid::Which::kAll);
  moved_.resize(awake_.size());
  for_chunks(awake_.size(), kChips, [&](std::size_t begin, std::size_t end, std::size_t) {
    ObstacleGrid::Near near;
    for (std::size_t i = begin; i < end; i += kBatch) {
      const std::size_t count = std::min(kBatch, end - i);
      const std::span chips(&awake_[i], count);
      for (std::size_t n = i + count; n < std::min(i + count + kBatch, end); ++n) fetch(awake_[n]);
      move(chips, {&moved_[i], count}, dt_s, obstacles.ground_m, near);
      spin(chips, {&moved_[i], count}, static_cast<float>(dt_s));
    }
  });
}

/// Asks memory for what a batch will read.
void Debris::fetch(std::uint32_t chip) const {
  const auto ask = [chip](const auto&... arrays) { (__builtin_prefetch(&arrays[chip]), ...); };
  ask(position_W_, velocity_W_, angular_velocity_W_, rotation_WD_, radius_m_);
}

/// They fly to their first touch, bounce, fly on.
void Debris::move(std::span<const std::uint32_t> chips, std::span<Moved> moved, double dt_s,
                  double ground_m, ObstacleGrid::Near& near) {
  std::array<SphereWay, kBatch> ways;      // of those that still fly
  std::array<std::size_t, kBatch> flying;  // which of `chips` they are
  std::array<std::optional<ObstacleTouch>, kBatch> touches;
  const Vec3f fall = (dt_s * gravity_W_).cast<float>();
  for (std::size_t i = 0; i < chips.size(); ++i) {
    velocity_W_[chips[i]] += fall;
    ways[i].from = position_W_[chips[i]].cast<double>();
    ways[i].radius_m = double{radius_m_[chips[i]]};
    ways[i].duration_s = dt_s;
    flying[i] = i;
    moved[i] = {};
  }
  std::size_t count = chips.size();
  for (int bounces = 0; count > 0; ++bounces) {
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3f& velocity = velocity_W_[chips[flying[i]]];
      ways[i].to = ways[i].from + ways[i].duration_s * velocity.cast<double>();
    }
    grid_.find(std::span(ways.data(), count), near);
    for (std::size_t i = 0; i < count; i += kLanes) {
      const std::size_t some = std::min<std::size_t>(kLanes, count - i);
      grid_.sweep({&ways[i], some}, near, {&touches[i], some});
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t which = flying[i];
      const bool on = goes_on(chips[which], ways[i], touches[i], dt_s, ground_m, moved[which]);
      if (!on || bounces == kBounces) continue;
      ways[left] = ways[i];
      flying[left++] = which;
    }
    count = left;
  }
}

/// Takes a chip to the end of its way, or to what it touches first: then it may go on from there.
bool Debris::goes_on(std::uint32_t chip, SphereWay& way, std::optional<ObstacleTouch> touch,
                     double dt_s, double ground_m, Moved& moved) {
  const double lowest = ground_m + way.radius_m;
  const double fall = way.from.y() - way.to.y();
  if (way.to.y() < lowest) {
    const double time = way.from.y() > lowest && fall > 0 ? (way.from.y() - lowest) / fall : 0;
    if (!touch || time < touch->time) {
      touch = ObstacleTouch{time, lowest - way.to.y(), Vec3::UnitY(), Vec3::Zero(), kGround};
    }
  }
  if (!touch) {
    way.from = way.to;
    way.duration_s = 0;
  } else {
    moved = {true, touch->velocity_W.norm() < ObstacleGrid::kCreep_m_s, touch->body};
    if (touch->depth_m > 0 && touch->time <= 0) {
      way.from = way.to + std::min(touch->depth_m, kPushOut_m_s * dt_s) * touch->normal_W;
      way.duration_s = 0;
    } else {
      way.from += touch->time * (way.to - way.from);
      way.duration_s *= 1 - touch->time;
    }
    way.from += kSkin_m * touch->normal_W;
    bounce(velocity_W_[chip], angular_velocity_W_[chip], radius_m_[chip],
           touch->normal_W.cast<float>(), touch->velocity_W.cast<float>());
  }
  way.from.y() = std::max(way.from.y(), lowest);
  position_W_[chip] = way.from.cast<float>();
  return way.duration_s > 0;
}

/// Turns them by how they spin; accurate for turns well below a radian.
void Debris::spin(std::span<const std::uint32_t> chips, std::span<const Moved> moved, float dt_s) {
  const float touched = 1 / (1 + dt_s * kTouchedDamping_s);
  const float flying = 1 / (1 + dt_s * kFlyingDamping_s);
  float q[4][kBatch] = {}, w[3][kBatch] = {};
  for (std::size_t i = 0; i < chips.size(); ++i) {
    Vec3f& spin = angular_velocity_W_[chips[i]];
    spin *= moved[i].touched ? touched : flying;
    for (int axis = 0; axis < 3; ++axis) w[axis][i] = 0.5f * dt_s * spin[axis];
    for (int part = 0; part < 4; ++part) q[part][i] = rotation_WD_[chips[i]].coeffs()[part];
  }
  float scale[kBatch];
  for (std::size_t i = 0; i < kBatch; ++i) {
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
    const std::uint32_t body = moved_[i].support;
    const bool still = moved_[i].lies && velocity_W_[chip].squaredNorm() < kStill_m_s * kStill_m_s;
    still_s_[chip] = still ? still_s_[chip] + static_cast<float>(dt_s) : 0;
    if (still_s_[chip] < kStill_s) continue;
    state_[chip] = State::kAsleep;
    velocity_W_[chip].setZero();
    angular_velocity_W_[chip].setZero();
    rest_[chip] = next_rest_++;
    support_[chip] = body == kGround ? kGround : obstacles.bodies[body].key;
    if (body != kGround) add_support(obstacles.bodies[body]);
    listed_ = false;
  }
}

void Debris::add_support(const ObstacleBody& body) {
  const auto at = std::lower_bound(supports_.begin(), supports_.end(), body.key,
                                   [](const Support& s, std::uint32_t key) { return s.key < key; });
  if (at == supports_.end() || at->key != body.key)
    supports_.insert(at, {body.key, body.edits, body.X_WB});
}

/// Makes room before the limit is reached: those go that have lain long and are small, a chip of
/// twice the radius when it has lain four times as long. They shrink until they are gone.
void Debris::fade(float dt_s) {
  const std::size_t kept = limit_ - limit_ / kChipRoom;
  const std::size_t staying = awake_.size() + asleep_.size();
  if (staying > kept && !asleep_.empty()) {
    const std::size_t count = std::min(staying - kept + limit_ / kChipRoom, asleep_.size());
    const auto end = asleep_.begin() + static_cast<std::ptrdiff_t>(count);
    const auto stays = [&](std::uint32_t chip) {
      const auto lain = static_cast<double>(next_rest_ - rest_[chip]);
      return double{radius_m_[chip]} * double{radius_m_[chip]} / lain;
    };
    std::nth_element(asleep_.begin(), end - 1, asleep_.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double of_a = stays(a), of_b = stays(b);
                       return of_a != of_b ? of_a < of_b : rest_[a] < rest_[b];
                     });
    for (auto chip = asleep_.begin(); chip != end; ++chip) state_[*chip] = State::kFading;
    listed_ = false;
  }
  // From the last, because removal moves the last chip into the gap.
  std::ranges::sort(fading_);
  for (auto chip = fading_.rbegin(); chip != fading_.rend(); ++chip) {
    drawn_radius_m_[*chip] -= radius_m_[*chip] * dt_s / kFade_s;
    if (drawn_radius_m_[*chip] <= 0) remove(*chip);
  }
}

void Debris::remove(std::uint32_t chip) {
  const auto drop = [chip](auto&... arrays) {
    ((arrays[chip] = arrays.back(), arrays.pop_back()), ...);
  };
  drop(position_W_, velocity_W_, angular_velocity_W_, rotation_WD_, radius_m_, drawn_radius_m_,
       still_s_, variant_, material_, state_, support_, rest_);
  ++ledger_.gone;
  listed_ = false;
}

/// Sorts all chips by state.
void Debris::list() {
  awake_.clear();
  asleep_.clear();
  fading_.clear();
  asleep_box_ = Box();
  // A chip that went left its number, the last, to none.
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
  listed_ = true;
}

DebrisView Debris::view() const {
  return {position_W_, rotation_WD_, drawn_radius_m_, variant_, material_};
}

ParticleLedger Debris::ledger() const {
  ParticleLedger ledger = ledger_;
  ledger.alive = static_cast<std::uint32_t>(position_W_.size());
  ledger.awake = static_cast<std::uint32_t>(awake_.size());
  return ledger;
}

}  // namespace sunder::solver
