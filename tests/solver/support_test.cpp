// Tests that bodies fall when they lose their support at any step while falling asleep: a thousand
// random piles, arches, lintels and frames lose a random support at a random step. Begin reading at
// run_case().
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/trigonometry.h"
#include "tests/fixtures/rigid_world.h"
#include "tests/solver/random_structures.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 60;
constexpr int kSubsteps = 4;

/// A body that moved by less has not fallen; gaps between bodies without contact are wider.
constexpr double kMoved_m = 0.003;

constexpr std::uint32_t kGround = ~0u;  ///< Tag of the ground; the tag of a body is its index.

/// A structure in a world, whose support can be removed.
class Scene {
 public:
  Scene(const Structure& structure, bool sleep)
      : bodies_(structure.bodies),
        support_(structure.support),
        loss_(structure.loss),
        top_W_(structure.top_W),
        world_(options(sleep)) {
    BodyDesc ground = W::ground();
    ground.tag = kGround;
    world_.add(ground);
    for (std::size_t i = 0; i < size(); ++i) {
      bodies_[i].tag = static_cast<std::uint32_t>(i);
      ids_.push_back(loss_ == Loss::kCut && is_support(i) ? BodyId() : world_.add(bodies_[i]));
    }
    if (loss_ != Loss::kCut) return;
    // A joint to the world holds the slab in place of the leg.
    std::size_t slab = support_;
    while (bodies_[slab].X_WB.position.y() < top_W_.y()) ++slab;
    joint_ =
        world_.physics().join(joint_at(world_, JointKind::kBall, BodyId(), ids_[slab], top_W_));
  }

  void step() { world_.step(kDt_s, kSubsteps); }
  void lose_support() {
    Physics& physics = world_.physics();
    BodyId& id = ids_[support_];
    BodyDesc& desc = bodies_[support_];
    BodyState state;
    if (!id.none()) state = world_.state(id);
    if (loss_ == Loss::kCut) {
      physics.cut(joint_);
    } else if (loss_ == Loss::kEdited) {
      physics.edit({id, std::span(&desc.shapes[0].tag, 1), {}});
    } else if (loss_ == Loss::kDriven) {
      state.velocity_W = Vec3(0, -20, 0);
      physics.set_state(id, state);
    } else if (loss_ == Loss::kTeleported) {
      state.X_WB.position.y() -= 50;
      physics.set_state(id, state);
    } else if (loss_ == Loss::kRemoved) {
      world_.remove(id);
      id = {};
    } else {
      const double height_m = 2 * (top_W_ - desc.X_WB.position).y();
      desc = W::box(Vec3(0.1, 0.7 * height_m, 0.1),
                    state.X_WB.position - Vec3(0, 0.15 * height_m, 0), 2000);
      desc.tag = static_cast<std::uint32_t>(support_);
      id = world_.replace({id}, {desc}).front();
    }
  }
  void pause(std::size_t body) {
    if (!is_support(body)) world_.physics().pause(std::span(&ids_[body], 1));
  }
  /// Returns the points where bodies other than the support touch each other or the ground.
  std::vector<Touch> touches() {
    std::vector<BodyId> all;
    for (std::size_t i = 0; i < size(); ++i)
      if (!is_support(i)) all.push_back(ids_[i]);
    world_.physics().collide(kDt_s);
    std::vector<Touch> touches = world_.physics().touches(all);
    std::erase_if(touches, [&](const Touch& touch) {
      return touch.body_tag_a == support_ || touch.body_tag_b == support_;
    });
    return touches;
  }
  /// Wakes all bodies.
  void wake() {
    for (std::size_t i = 0; i < size(); ++i)
      if (!is_support(i)) world_.physics().apply_impulse(ids_[i], Vec3::Zero(), Vec3::Zero());
  }

  std::size_t size() const { return bodies_.size(); }
  bool is_support(std::size_t body) const { return body == support_; }
  const BodyDesc& desc(std::size_t body) const { return bodies_[body]; }
  BodyState state(std::size_t body) const { return world_.state(ids_[body]); }
  /// Returns the states by body; that of the support is not set.
  std::vector<BodyState> states() const {
    std::vector<BodyState> states(size());
    for (std::size_t i = 0; i < size(); ++i)
      if (!is_support(i)) states[i] = state(i);
    return states;
  }
  std::size_t count_asleep() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < size(); ++i) count += !is_support(i) && state(i).asleep;
    return count;
  }
  bool is_all_asleep() const { return count_asleep() + 1 == size(); }

 private:
  static RigidOptions options(bool sleep) {
    RigidOptions options;
    options.sleeping = sleep;
    return options;
  }

  std::vector<BodyDesc> bodies_;
  std::size_t support_ = 0;
  Loss loss_ = Loss::kRemoved;
  Vec3 top_W_ = Vec3::Zero();
  RigidWorld world_;
  std::vector<BodyId> ids_;
  JointId joint_;
};

/// Returns a bound on the distance that any point within half a metre of a body's centre has moved.
double motion_bound_m(const BodyState& from, const BodyState& to) {
  return (to.X_WB.position - from.X_WB.position).norm() +
         0.5 * from.X_WB.rotation.angularDistance(to.X_WB.rotation);
}

/// Returns true if some line has the point on one side, farther away than the margin, and all
/// others on the other side.
bool is_outside(const Vec2& point, const std::vector<Vec2>& others, double margin_m) {
  constexpr int kDirections = 180;
  for (int i = 0; i < kDirections; ++i) {
    const SinCos a = sin_cos(2 * std::numbers::pi * i / kDirections);
    const auto separated = [&](const Vec2& other) {
      return (point - other).dot(Vec2(a.cos, a.sin)) > margin_m;
    };
    if (std::ranges::all_of(others, separated)) return true;
  }
  return false;
}

/// A contact that supports body `of` by body `by`, or by the ground.
struct Contact {
  std::uint32_t of, by;
  Vec3 up_W, point_W;
};

std::vector<Contact> find_contacts(Scene& scene) {
  std::vector<Contact> contacts;
  for (const Touch& t : scene.touches()) {
    const std::uint32_t a = t.body_tag_a, b = t.body_tag_b;
    const Vec3 point_W = a == kGround ? Vec3(scene.state(b).X_WB.position + t.arm_b_W)
                                      : Vec3(scene.state(a).X_WB.position + t.arm_a_W);
    if (a != kGround) contacts.push_back({a, b, -t.normal_W, point_W});
    if (b != kGround) contacts.push_back({b, a, t.normal_W, point_W});
  }
  return contacts;
}

/// Returns the body and all that it supports, if statics says that they must fall: nothing supports
/// them, or all of their supports are level and vertical, and their centre of mass is outside of
/// these. Empty otherwise.
std::vector<std::uint32_t> find_unsupported(const Scene& scene, std::uint32_t body,
                                            const std::vector<Contact>& contacts) {
  std::vector<std::uint32_t> below = {kGround}, set = {body};
  const auto has = [](const std::vector<std::uint32_t>& all, std::uint32_t one) {
    return std::ranges::find(all, one) != all.end();
  };
  for (const Contact& c : contacts)
    if (c.of == body && c.up_W.y() > 0.5) below.push_back(c.by);
  for (std::size_t i = 0; i < set.size(); ++i)
    for (const Contact& c : contacts)
      if (c.of == set[i] && !has(below, c.by) && !has(set, c.by)) set.push_back(c.by);
  std::vector<Vec2> feet;
  double lowest_m = 1e9, highest_m = -1e9;
  for (const Contact& c : contacts) {
    if (!has(set, c.of) || has(set, c.by)) continue;
    if (c.up_W.y() < 0.999) return {};
    feet.emplace_back(c.point_W.x(), c.point_W.z());
    lowest_m = std::min(lowest_m, c.point_W.y()), highest_m = std::max(highest_m, c.point_W.y());
  }
  if (highest_m - lowest_m > 0.02) return {};
  Vec3 center = Vec3::Zero();
  double mass_kg = 0;
  for (const std::uint32_t i : set) {
    center += scene.desc(i).mass_kg * scene.state(i).X_WB.position;
    mass_kg += scene.desc(i).mass_kg;
  }
  const Vec2 center_m = Vec2(center.x(), center.z()) / mass_kg;
  return is_outside(center_m, feet, 0.02) ? set : std::vector<std::uint32_t>();
}

struct Counts {
  /// Cases, by the bodies asleep at the loss.
  int cases = 0, none_slept = 0, some_slept = 0, all_slept = 0;
  int about_sleep = 0;  ///< Cases with the loss at most six steps from a body's falling asleep.
  std::array<int, kLossNames.size()> losses = {};
  /// Bodies that must fall with all that they support: without a contact; with their centre of mass
  /// outside of their supports.
  int without_contact = 0, outside = 0;
  /// Bodies that fell in the world without sleep; those of them that stayed here.
  int moved_without_sleep = 0, stayed = 0;
  /// Cases that end asleep; bodies that fall when they are woken then.
  int rested = 0, unsound = 0;
};

/// Returns the step at which a body falls asleep; at most 120, two seconds.
int step_of_sleep(const Structure& structure, std::size_t body) {
  Scene scene(structure, true);
  int step = 0;
  for (; step < 120 && (scene.is_support(body) || !scene.state(body).asleep); ++step) scene.step();
  return step;
}

/// Removes a support of a structure. Bodies that must fall by statics have to move, nearly all
/// bodies that fall in a world without sleep have to move, and bodies asleep at the end have to
/// stay when they are woken.
void run_case(Kind kind, std::uint64_t seed, Counts& counts) {
  Random random(seed, static_cast<std::uint64_t>(kind));
  const Structure structure = make_structure(kind, random);
  Scene scene(structure, true), without_sleep(structure, false);
  const auto some_body = [&] { return random.below(static_cast<std::uint32_t>(scene.size())); };
  int steps = static_cast<int>(random.below(90));
  if (random.below(2) == 0) {
    const std::uint32_t watched = some_body();
    if (!scene.is_support(watched)) {
      const int sleeps = step_of_sleep(structure, watched);
      steps = std::max(0, sleeps - 6 + static_cast<int>(random.below(9)));
      ++counts.about_sleep;
    }
  }
  for (int i = 0; i < steps; ++i) scene.step(), without_sleep.step();
  ++counts.cases;
  ++counts.losses[static_cast<std::size_t>(structure.loss)];
  ++(scene.count_asleep() == 0 ? counts.none_slept
     : scene.is_all_asleep()   ? counts.all_slept
                               : counts.some_slept);
  const std::vector<BodyState> from = scene.states(), without_sleep_from = without_sleep.states();
  scene.lose_support(), without_sleep.lose_support();
  const std::vector<Contact> contacts = find_contacts(scene);
  std::vector<std::vector<std::uint32_t>> unsupported;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    if (scene.is_support(i)) continue;
    std::vector<std::uint32_t> set = find_unsupported(scene, i, contacts);
    if (set.empty()) continue;
    const auto held = [&](const Contact& c) { return c.of == i; };
    ++(std::ranges::none_of(contacts, held) ? counts.without_contact : counts.outside);
    unsupported.push_back(std::move(set));
  }
  const std::uint32_t paused = random.below(8) == 0 ? some_body() : kGround;
  for (int i = 0; i < 60; ++i) {
    if (i < 3 && paused != kGround) scene.pause(paused), without_sleep.pause(paused);
    scene.step(), without_sleep.step();
  }
  const std::vector<BodyState> to = scene.states(), without_sleep_to = without_sleep.states();
  for (const std::vector<std::uint32_t>& set : unsupported) {
    const auto moved = [&](std::uint32_t i) { return motion_bound_m(from[i], to[i]) > kMoved_m; };
    if (std::ranges::any_of(set, moved)) continue;
    ADD_FAILURE() << "body " << set[0] << " of case " << seed << " does not fall after step "
                  << steps;
  }
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (scene.is_support(i) || motion_bound_m(without_sleep_from[i], without_sleep_to[i]) < 0.1)
      continue;
    ++counts.moved_without_sleep;
    counts.stayed += motion_bound_m(from[i], to[i]) < kMoved_m;
  }
  for (int i = 0; i < 120 && !scene.is_all_asleep(); ++i) scene.step();
  if (!scene.is_all_asleep()) return;
  ++counts.rested;
  const std::vector<BodyState> end = scene.states();
  scene.wake();
  for (int i = 0; i < 20; ++i) scene.step();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (scene.is_support(i)) continue;
    const double fall_m = end[i].X_WB.position.y() - scene.state(i).X_WB.position.y();
    counts.unsound += fall_m > 0.05;  // A body without support would fall half a metre.
  }
}

class LostSupport : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Random, LostSupport,
                         testing::Values(Kind::kPile, Kind::kArch, Kind::kFrame),
                         [](const auto& kind) {
                           return kKindNames[static_cast<std::size_t>(kind.param)];
                         });

TEST_P(LostSupport, MakesBodiesFallAtAnyStepOfFallingAsleep) {
  Counts counts;
  for (int seed = 0; seed < 334; ++seed)
    run_case(GetParam(), static_cast<std::uint64_t>(seed), counts);
  std::printf("%d %s: none slept in %d, some in %d, all in %d; about falling asleep: %d\n",
              counts.cases, kKindNames[static_cast<std::size_t>(GetParam())], counts.none_slept,
              counts.some_slept, counts.all_slept, counts.about_sleep);
  for (std::size_t i = 0; i < kLossNames.size(); ++i)
    std::printf("  %s: %d", kLossNames[i], counts.losses[i]);
  std::printf("\n  must fall: without contact: %d, centre of mass outside: %d\n",
              counts.without_contact, counts.outside);
  std::printf("  fell in a world that never sleeps: %d, stayed here: %d\n",
              counts.moved_without_sleep, counts.stayed);
  std::printf("  cases that ended asleep: %d, bodies that fell when woken: %d\n", counts.rested,
              counts.unsound);
  EXPECT_GT(counts.none_slept, 50);
  EXPECT_GT(counts.some_slept + counts.all_slept, 50);
  EXPECT_GT(counts.about_sleep, 100);
  EXPECT_GT(counts.without_contact + counts.outside, 200);
  EXPECT_GT(counts.moved_without_sleep, 500);
  EXPECT_GT(counts.rested, 200);
  // A stone that fell with its half of an arch in one world may stand alone in the other.
  EXPECT_LE(counts.stayed * 100, counts.moved_without_sleep);
  EXPECT_EQ(counts.unsound, 0);
}

}  // namespace
}  // namespace sunder::solver
