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

  explicit StruckWall(const Preset& preset, std::uint64_t seed)
      : world(options_of(preset, awake())) {
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

/// A box that falls flat.
struct Landing {
  const char* name;
  Vec3 size_m;
  double down_m_s;  ///< Speed at the start of the fall.
};
constexpr double kLandingFriction = 0.5;

/// Returns the error of the distance that a box slides after it lands, over the error allowed. By
/// Coulomb's law, a landing takes friction times the closing speed from the speed along the ground.
double landing_error(const Preset& preset, const Landing& landing, double angle_deg, double phase) {
  const double along_m_s = landing.down_m_s / std::tan(angle_deg * kPi / 180);
  const double gap_m = landing.down_m_s * preset.dt_s * (1.5 + phase);
  PresetWorld world(preset);
  world.add(RigidWorld::with_friction(RigidWorld::ground(), kLandingFriction));
  const BodyDesc box =
      RigidWorld::box(landing.size_m, Vec3(0, 0.5 * landing.size_m.y() + gap_m, 0), 2000);
  const BodyId id = world.add(RigidWorld::moving(RigidWorld::with_friction(box, kLandingFriction),
                                                 Vec3(along_m_s, -landing.down_m_s, 0)));
  const double closing_m_s = std::sqrt(landing.down_m_s * landing.down_m_s + 2 * kG * gap_m);
  const double fall_s = (closing_m_s - landing.down_m_s) / kG;
  const double left_m_s = std::max(0.0, along_m_s - kLandingFriction * closing_m_s);
  const double brake_m_s2 = kLandingFriction * kG;
  world.run(fall_s + left_m_s / brake_m_s2 + 0.3);
  const double slid_m = world.state(id).X_WB.position.x() - along_m_s * fall_s;
  const double theory_m = left_m_s * left_m_s / (2 * brake_m_s2);
  // The box is braked up to two substeps late, and may tilt.
  const double late_m = 2 * along_m_s * preset.dt_s / preset.substeps + 0.007 * landing.size_m.y();
  const double frictionless_m = along_m_s * along_m_s / (2 * brake_m_s2);
  return std::abs(slid_m - theory_m) / (0.05 * theory_m + 0.01 * frictionless_m + late_m);
}

TEST(Coulomb, brakes_a_box_in_the_instant_of_its_landing) {
  const Landing landings[] = {{"slab", Vec3(1.5, 0.3, 1.5), 6},
                              {"slow plate", Vec3(0.5, 0.2, 0.4), 1},
                              {"cube", Vec3(0.5, 0.5, 0.5), 3},
                              {"fast sheet", Vec3(0.4, 0.04, 0.4), 20}};
  for (const Preset& preset : kPresets)
    for (const Landing& landing : landings)
      for (const double angle_deg : {10., 20., 30., 40., 50., 60., 70., 80.})
        for (const double phase : {0.1, 0.6})
          EXPECT_LT(landing_error(preset, landing, angle_deg, phase), 1)
              << preset.name << ": " << landing.name << " at " << angle_deg << " degrees, phase "
              << phase;
}

}  // namespace
}  // namespace sunder::solver
