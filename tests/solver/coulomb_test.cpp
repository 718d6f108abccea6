// Tests that friction of the ground obeys Coulomb's law in every step, impacts included.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

constexpr double kFriction = 0.6;

/// A dry wall of blocks on the ground, and a ball that strikes it.
struct StruckWall {
  RigidWorld world;
  std::vector<BodyId> ids;
  std::vector<double> masses_kg;
  double ball_Ns = 0;

  explicit StruckWall(const Preset& preset, std::uint64_t seed) : world(options(preset)) {
    Random random(seed, 3);
    world.add(RigidWorld::fixed(
        RigidWorld::with_friction(RigidWorld::box(Vec3(40, 1, 40), Vec3(0, -0.5, 0)), kFriction)));
    for (int course = 0; course < 8; ++course) {
      for (int block = 0; block < 8; ++block) {
        const double x_m = 0.4 * (block - 4) + (course % 2 == 0 ? 0 : 0.2);
        add(RigidWorld::box(Vec3(0.4, 0.2, 0.3), Vec3(x_m, 0.1 + 0.2 * course, 0)));
      }
    }
    const double speed_m_s = 15 + 5 * static_cast<double>(seed);
    BodyDesc ball =
        RigidWorld::sphere(0.3, Vec3(random.uniform(-.3, .3), random.uniform(0.3, 1.2), 1), 7800);
    ball_Ns = ball.mass_kg * speed_m_s;
    add(RigidWorld::moving(ball, Vec3(0, 0, -speed_m_s)));
  }

  static RigidOptions options(const Preset& preset) {
    RigidOptions options = awake();
    options.sweeps = preset.sweeps;
    return options;
  }
  void add(const BodyDesc& body) {
    masses_kg.push_back(body.mass_kg);
    ids.push_back(world.add(RigidWorld::with_friction(body, kFriction)));
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < ids.size(); ++i)
      sum += masses_kg[i] * world.state(ids[i]).velocity_W;
    return sum;
  }
};

TEST(Coulomb, limits_the_friction_of_the_ground_on_a_wall_that_is_struck) {
  for (const Preset& preset : kPresets) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      StruckWall wall(preset, seed);
      double mass_kg = 0;
      for (const double mass : wall.masses_kg) mass_kg += mass;
      Vec3 before = wall.momentum();
      for (int step = 0; step < std::lround(0.3 / preset.dt_s); ++step) {
        wall.world.step(preset.dt_s, preset.substeps);
        const Vec3 after = wall.momentum(), change = after - before;
        before = after;
        const double up_Ns = change.y() + kG * mass_kg * preset.dt_s;
        const double along_Ns = std::hypot(change.x(), change.z());
        EXPECT_LE(along_Ns, kFriction * std::max(0.0, up_Ns) + 1e-3 * wall.ball_Ns)
            << preset.name << ", seed " << seed << ", step " << step;
      }
    }
  }
}

}  // namespace
}  // namespace sunder::solver
