// Impacts pass in one step through all that touches (docs/decisions/036). How well they do in
// rubble is a truth (bench/truths/through.cpp).
#include <gtest/gtest.h>

#include "bench/truths/presets.h"
#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 120, kSpeed_m_s = 100;
constexpr int kSubsteps = 4, kSide = 10;  // more posts than there are colours

/// A plate that strikes posts which touch another plate, all of them free.
RigidWorld plate_strikes_posts(int lanes) {
  RigidOptions options = awake(Vec3::Zero());
  options.lanes = lanes;
  RigidWorld world(options);
  const Vec3 plate(kSide, 0.2, kSide), post(0.5, 1, 0.5);
  world.add(W::moving(W::box(plate, Vec3(0, 0.6, 0)), Vec3(0, -kSpeed_m_s, 0)));
  world.add(W::box(plate, Vec3(0, -0.6, 0)));
  for (int i = 0; i < kSide * kSide; ++i)
    world.add(W::box(post, Vec3(i % kSide - 4.5, 0, i / kSide - 4.5), 100));
  return world;
}

TEST(Impact, PassesInOneStepThroughMoreContactsThanThereAreColours) {
  RigidWorld world = plate_strikes_posts(0);
  const Vec3 before = world.momentum();
  const double common_m_s = before.y() / world.step(kDt_s, kSubsteps).mass_kg;
  for (std::size_t i = 0; i < world.size(); ++i)
    EXPECT_NEAR(world.state(world.id(i)).velocity_W.y() / common_m_s, 1, 0.15) << i;
  EXPECT_NEAR(world.momentum().y() / before.y(), 1, 1e-5);
}

TEST(Impact, GivesTheSameBitsForAnyNumberOfThreadsAndLanes) {
  const int before = threads();
  const auto hash = [](int lanes, int thread_count) {
    set_threads(thread_count);
    RigidWorld world = plate_strikes_posts(lanes);
    for (int i = 0; i < 10; ++i) world.step(kDt_s, kSubsteps);
    return world.hash();
  };
  const std::uint64_t one = hash(1, 1);
  for (const int lanes : {4, 8, 16}) EXPECT_EQ(hash(lanes, 2), one) << lanes;
  EXPECT_EQ(hash(0, 5), one);
  set_threads(before);
}

}  // namespace
}  // namespace sunder::solver
