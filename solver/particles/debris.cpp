// Read first: advance(), the list of a step's stages, then move().
#include "solver/particles/debris.h"

#include <algorithm>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "solver/particles/turn.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kGround = 0xffffffff;  // as a support
constexpr std::size_t kChunk = 256;
constexpr float kFriction = 0.6f;
constexpr float kRestitution = 0.3f;
constexpr float kBounce_m_s = 0.4f;       // slower approaches do not bounce
constexpr double kSkin_m = 2e-4;          // kept between a chip and what it lies on
constexpr float kAround_m = 0.005f;       // of its way, that a bounce may need
constexpr double kPushOut_m_s = 2;        // of what starts inside an obstacle
constexpr float kTouchedDamping_s = 150;  // high, so that chips do not roll
constexpr float kFlyingDamping_s = 0.5f;
constexpr float kStill_m_s = 0.1f;
constexpr float kStill_s = 0.25f;
constexpr float kFade_s = 0.75f;
constexpr double kShifted = 1e-3;    // m or rad by which a support has moved
constexpr std::uint32_t kRoom = 16;  // one part in so many is kept free for new chips
constexpr int kBounces = 2;          // within one step

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
  ++books_.emitted;
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
  awake_.push_back(static_cast<std::uint32_t>(position_W_.size() - 1));
}

void Debris::advance(double dt_s, const Obstacles& obstacles) {
  if (position_W_.empty()) return;
  wake_unsupported(obstacles);
  wake_touched(dt_s, obstacles);
  if (!listed_) list();
  move_awake(dt_s, obstacles);
  put_to_sleep(dt_s, obstacles);
  fade(static_cast<float>(dt_s));
  if (!listed_) list();
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
    if (gone || shifted(support.X_WB, body->X_WB)) lost.push_back(support.key);
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
  for_chunks(asleep_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    ObstacleGrid::Near near;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& at = position_W_[asleep_[i]];
      const float radius = radius_m_[asleep_[i]];
      movers_.find(at - Vec3f::Constant(radius), at + Vec3f::Constant(radius), near);
      if (near.empty()) continue;
      const Vec3 here = at.cast<double>();
      touched[i] = movers_.sweep({here, here, double{radius}, dt_s}, near).has_value();
    }
  });
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched[i] && state_[asleep_[i]] == State::kAsleep) wake(asleep_[i]);
  }
}

void Debris::move_awake(double dt_s, const Obstacles& obstacles) {
  Box region;
  for (const std::uint32_t chip : awake_) {
    const Vec3 at = position_W_[chip].cast<double>();
    const Vec3 way = dt_s * (velocity_W_[chip].cast<double>() + dt_s * gravity_W_);
    const Vec3 reach = Vec3::Constant(double{radius_m_[chip]}) + way.cwiseAbs();
    region.extend(Box{at - reach, at + reach});
  }
  grid_.build(obstacles, dt_s, region, ObstacleGrid::Which::kAll);
  moved_.resize(awake_.size());
  for_chunks(awake_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    ObstacleGrid::Near near;
    for (std::size_t i = begin; i < end; ++i) {
      moved_[i] = move(awake_[i], dt_s, obstacles.ground_m, near);
      spin(awake_[i], static_cast<float>(dt_s), moved_[i].touched);
    }
  });
}

/// Flies to the first touch, bounces, flies on.
Debris::Moved Debris::move(std::uint32_t chip, double dt_s, double ground_m,
                           ObstacleGrid::Near& near) {
  Moved moved;
  const double radius = double{radius_m_[chip]};
  const double lowest = ground_m + radius;
  Vec3f& velocity = velocity_W_[chip];
  velocity += (dt_s * gravity_W_).cast<float>();
  Vec3 from = position_W_[chip].cast<double>();
  double left_s = dt_s;
  Vec3f known_low = Vec3f::Constant(1), known_high = Vec3f::Zero();  // where `near` holds
  for (int bounces = 0;; ++bounces) {
    Vec3 to = from + left_s * velocity.cast<double>();
    const Vec3f low = (from.cwiseMin(to).array() - radius).cast<float>();
    const Vec3f high = (from.cwiseMax(to).array() + radius).cast<float>();
    if ((low.array() < known_low.array()).any() || (high.array() > known_high.array()).any()) {
      known_low = low.array() - kAround_m;
      known_high = high.array() + kAround_m;
      grid_.find(known_low, known_high, near);
    }
    std::optional<Touch> touch = grid_.sweep({from, to, radius, left_s}, near);
    const double fall = from.y() - to.y();
    if (to.y() < lowest) {
      const double time = from.y() > lowest && fall > 0 ? (from.y() - lowest) / fall : 0;
      if (!touch || time < touch->time) {
        touch = Touch{time, lowest - to.y(), Vec3::UnitY(), Vec3::Zero(), kGround};
      }
    }
    if (!touch) {
      from = to;
      break;
    }
    moved = {true, touch->velocity_W.norm() < ObstacleGrid::kCreep_m_s, touch->body};
    if (touch->depth_m > 0 && touch->time <= 0) {
      from = to + std::min(touch->depth_m, kPushOut_m_s * dt_s) * touch->normal_W;
      left_s = 0;
    } else {
      from += touch->time * (to - from);
      left_s *= 1 - touch->time;
    }
    from += kSkin_m * touch->normal_W;
    bounce(velocity, angular_velocity_W_[chip], radius_m_[chip], touch->normal_W.cast<float>(),
           touch->velocity_W.cast<float>());
    if (bounces == kBounces || left_s <= 0) break;
  }
  from.y() = std::max(from.y(), lowest);
  position_W_[chip] = from.cast<float>();
  return moved;
}

void Debris::spin(std::uint32_t chip, float dt_s, bool touched) {
  Vec3f& spin = angular_velocity_W_[chip];
  spin *= 1 / (1 + dt_s * (touched ? kTouchedDamping_s : kFlyingDamping_s));
  turn(rotation_WD_[chip], spin, dt_s);
}

void Debris::put_to_sleep(double dt_s, const Obstacles& obstacles) {
  for (std::size_t i = 0; i < awake_.size(); ++i) {
    const std::uint32_t chip = awake_[i];
    const std::uint32_t body = moved_[i].support;
    const bool still = moved_[i].lies && velocity_W_[chip].norm() < kStill_m_s;
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
  if (at == supports_.end() || at->key != body.key) supports_.insert(at, {body.key, body.X_WB});
}

/// Makes room before the limit is reached: those that have lain longest shrink and go.
void Debris::fade(float dt_s) {
  const std::size_t kept = limit_ - limit_ / kRoom;
  const std::size_t staying = awake_.size() + asleep_.size();
  if (staying > kept && !asleep_.empty()) {
    const std::size_t count = std::min(staying - kept + limit_ / kRoom, asleep_.size());
    const auto end = asleep_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(asleep_.begin(), end - 1, asleep_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rest_[a] < rest_[b]; });
    for (auto chip = asleep_.begin(); chip != end; ++chip) state_[*chip] = State::kFading;
    listed_ = false;
  }
  // From the last, because removal moves the last chip into the gap.
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
  ++books_.gone;
  listed_ = false;
}

/// Sorts all chips by state.
void Debris::list() {
  awake_.clear();
  asleep_.clear();
  fading_.clear();
  asleep_box_ = Box();
  for (std::uint32_t chip = 0; chip < state_.size(); ++chip) {
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

ParticleBooks Debris::books() const {
  ParticleBooks books = books_;
  books.alive = static_cast<std::uint32_t>(position_W_.size());
  books.awake = static_cast<std::uint32_t>(awake_.size());
  return books;
}

}  // namespace sunder::solver
