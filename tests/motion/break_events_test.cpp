// Tests that each break event names a body of the frame before, and the bodies that came from it.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/motion/bending.h"
#include "tests/motion/run.h"

namespace sunder::tests {
namespace {

using Keys = std::set<std::uint64_t>;

Keys keys_of(const Frame& frame) {
  Keys keys;
  for (const FrameBody& body : frame.bodies) keys.insert(body.key);
  return keys;
}

/// Checks the events of a frame in which no body bends, is rejoined or is released. Returns the
/// number of bodies that were created and broken within the frame.
std::size_t expect_attributed(const Frame& before, const Frame& frame) {
  const Keys last = keys_of(before), now = keys_of(frame);
  Keys created;
  std::size_t short_lived = 0;
  for (std::size_t i = 0; i < frame.breaks.size(); ++i) {
    const BreakEvent& event = frame.breaks[i];
    const bool is_known = last.contains(event.parent_key);
    EXPECT_TRUE(is_known || created.contains(event.parent_key)) << event.parent_key;
    EXPECT_TRUE(last.contains(event.previous_key)) << event.previous_key;
    EXPECT_LT(event.material.value, frame.materials->size());
    EXPECT_LE(event.child_keys.size(), event.pieces);
    short_lived += is_known ? 0 : 1;
    for (const std::uint64_t child : event.child_keys) {
      const auto breaks = [&](const BreakEvent& later) { return later.parent_key == child; };
      EXPECT_TRUE(now.contains(child) ||
                  std::any_of(frame.breaks.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                              frame.breaks.end(), breaks))
          << child;
      created.insert(child);
    }
  }
  for (const std::uint64_t key : now)
    EXPECT_TRUE(last.contains(key) || created.contains(key)) << key << " is in no break event";
  return short_lived;
}

/// Returns a scene of blocks, each hit by a ball, with eight steps a frame.
Scene collision(std::uint64_t seed) {
  Scene scene = bare_scene(1.0 / 480, 5, 2000);
  scene.materials[0].smallest_break_m3 = 1e-6;
  Random random(seed);
  for (int i = 0; i < 6; ++i) {
    const Vec3 at(1.2 * (i % 3), 1.2 * (i / 3), 0);
    scene.solids.push_back(box_solid(at, Vec3(1, 1, 1)));
    scene.balls.push_back(
        steel_ball(0.1, at + Vec3(0.3, 0, 0.7 + 0.2 * random.uniform()), Vec3(0, 0, -60)));
  }
  return scene;
}

TEST(BreakEvents, NameBodiesOfTheFrameBeforeOrOfEarlierEvents) {
  std::size_t events = 0, short_lived = 0;
  for (const std::uint64_t seed : {1u, 2u}) {
    Trial trial(collision(seed));
    for (int i = 0; i < 6; ++i) {
      const FramePtr before = trial.frame;
      trial.step();
      short_lived += expect_attributed(*before, *trial.frame);
      events += trial.frame->breaks.size();
    }
  }
  EXPECT_GT(events, 20u);
  EXPECT_GT(short_lived, 0u) << "no body was created and broken within a frame";
}

TEST(BreakEvents, OfBendingBarsNameBodiesOfTheFrameBefore) {
  std::size_t events = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    BendingRun bending(thrown_bars(seed));
    for (int i = 0; i < 30; ++i) {
      const Keys last = keys_of(*bending.frame);
      bending.step();
      for (const BreakEvent& event : bending.frame->breaks) {
        EXPECT_TRUE(last.contains(event.previous_key)) << event.previous_key;
        EXPECT_FALSE(event.child_keys.empty());
        ++events;
      }
    }
  }
  EXPECT_GT(events, 0u);
}

}  // namespace
}  // namespace sunder::tests
