// Tests of bars in concrete: their strength is that of the theory of reinforced concrete, and they
// hold together a column that is shot.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/io/state_hash.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::tests::rebar_test {
namespace {

constexpr double kG = 9.81, kWide = 0.2, kLong = 1.6;  // m
constexpr double kBar = 0.02, kDepth = 0.17;           // of bars; depth from the compressed edge
constexpr double kYield_Pa = 2.5e7;
constexpr double kMomentCapacity_Nm = 2 * kBar * kBar * kYield_Pa * kDepth;  // A_s f_y z
constexpr std::uint64_t kSettled = 12;                                       // frame
constexpr MaterialIndex kConcrete{0}, kSteel{1};

/// Returns a cantilever along x of concrete cubes, with two bars near its upper side, or none.
Solid beam(bool with_bars) {
  std::vector<Part> parts;
  const int blocks = static_cast<int>(std::lround(kLong / kWide));
  for (const double z : {0.03, kWide - 0.03 - kBar}) {
    for (int i = -1; with_bars && i < blocks; ++i) {
      const Vec3 corner(i * kWide, kDepth - kBar / 2, z);
      parts.push_back({make_box(corner, corner + Vec3(kWide, kBar, kBar)), kSteel, i < 0});
    }
  }
  for (int i = -1; i < blocks; ++i) {
    const Vec3 corner(i * kWide, 0, 0);
    parts.push_back({make_box(corner, corner + Vec3::Constant(kWide)), kConcrete, i < 0});
  }
  return {"beam", scenes::make_compound(std::move(parts)), {}};
}

/// Returns a scene of a beam whose self-weight loads its bars with this part of their strength.
Scene loaded(bool with_bars, double part) {
  Scene scene;
  Material concrete, steel;
  concrete.name = "concrete", steel.name = "steel";
  concrete.density_kg_m3 = 2 * part * kMomentCapacity_Nm / (kG * kWide * kWide * kLong * kLong);
  steel.density_kg_m3 = concrete.density_kg_m3;
  concrete.tensile_Pa = 3e5, concrete.shear_Pa = 2e6;
  steel.youngs_Pa = 2e11, steel.yield_Pa = kYield_Pa;
  scene.materials = {concrete, steel};
  scene.ground.height_m = -1000;
  scene.limits.load_work_a_frame = 1000000000;
  scene.duration_s = 2;
  scene.solids = {beam(with_bars)};
  return scene;
}

struct Outcome {
  bool cracked = false;
  double fallen_m = 0, plastic_J = 0, mass_error = 0;
};

Outcome outcome(bool with_bars, double part) {
  const auto simulation = scenes::make_simulation(loaded(with_bars, part));
  Outcome result;
  double first_J = 0, first_kg = 0;
  while (const FramePtr frame = simulation->next()) {
    const auto& report = frame->report;
    if (frame->index == 0) first_kg = report.mass_kg;
    if (frame->index == kSettled) first_J = report.potential_J;  // of all bodies that move by then
    if (frame->index > kSettled) result.fallen_m = (first_J - report.potential_J) / (kG * first_kg);
    result.cracked |= !frame->breaks.empty();
    result.plastic_J = report.plastic_J;
    result.mass_error = std::max(result.mass_error, std::abs(report.mass_kg / first_kg - 1));
  }
  return result;
}

TEST(Rebar, holds_a_cracked_beam_up_to_the_strength_of_its_bars) {
  const Outcome holds = outcome(true, 0.85), flows = outcome(true, 1.15);
  EXPECT_TRUE(holds.cracked);
  EXPECT_LT(holds.fallen_m, 0.01);
  EXPECT_LT(holds.plastic_J, 0.05 * kMomentCapacity_Nm);
  EXPECT_TRUE(flows.cracked);
  EXPECT_GT(flows.fallen_m, 1);
  EXPECT_GT(flows.plastic_J, 0.05 * kMomentCapacity_Nm);
  for (const Outcome& each : {holds, flows}) EXPECT_LT(each.mass_error, 1e-12);
}

TEST(Rebar, is_all_that_holds_a_cracked_beam) { EXPECT_GT(outcome(false, 0.85).fallen_m, 1); }

/// Returns a scene of a column that is shot.
std::string column(int bars, int seed = 1) {
  return R"(
[scene]
description = "x"
duration_s = 3
seed = )" +
         std::to_string(seed) + R"(
[[material]]
name = "steel"
yield_Pa = 2.5e8
[[material]]
name = "concrete"
impact_radius_m = 0.6
smallest_break_m3 = 0.01
pattern = { kind = "voronoi", cells = 300, falloff = 1.5 }
[[solid]]
structure = "reinforced"
size_m = [0.4, 3.2, 0.4]
bar_m = 0.012
anchored = "bottom"
bars = )" +
         std::to_string(bars) +
         R"(
[script]
[[script.shot]]
time_s = 0
from = [0, 1.5, 2]
at = [0, 1.5, 0]
speed_m_s = 18
radius_m = 0.2
)";
}

struct Shot {
  double top_m = 0;  ///< Height of the highest mesh origin at the end.
  double broken_m2 = 0, mass_error = 0;
  std::vector<std::uint64_t> hashes;
};

Shot shot(int bars, int seed = 1) {
  const auto simulation =
      scenes::make_simulation(scenes::parse_scene(column(bars, seed), "x.toml", {}));
  Shot result;
  double first_kg = 0;
  while (const FramePtr frame = simulation->next()) {
    if (frame->index == 0) first_kg = frame->report.mass_kg;
    result.mass_error = std::max(result.mass_error, std::abs(frame->report.mass_kg / first_kg - 1));
    for (const BreakEvent& event : frame->breaks) result.broken_m2 += event.new_area_m2;
    result.hashes.push_back(hash_state(*frame));
    result.top_m = 0;
    for (const Instance& instance : frame->instances) {
      const FrameBody& body = frame->bodies[instance.body];
      const Vec3 place = body.X_WB * ((*frame->meshes)[instance.mesh.value]->origin_T - body.com_R);
      result.top_m = std::max(result.top_m, place.y());
    }
  }
  return result;
}

// A column falls if the pattern cuts all of its bars; most of five columns do not.
TEST(Rebar, holds_a_column_together_that_is_shot) {
  int hold = 0;
  for (int seed = 1; seed <= 5; ++seed) {
    const Shot with = shot(2, seed), without = shot(0, seed);
    EXPECT_GT(with.broken_m2, 0.3) << seed;
    EXPECT_LT(without.top_m, 1.5) << seed;
    EXPECT_LT(with.mass_error, 1e-12) << seed;
    hold += with.top_m > 2.5;
  }
  EXPECT_GE(hold, 3);
}

TEST(Rebar, breaks_alike_in_any_number_of_threads) {
  set_threads(1);
  const Shot one = shot(2);
  set_threads(2);
  const Shot two = shot(2);
  set_threads(0);
  EXPECT_EQ(one.hashes, two.hashes);
}

}  // namespace
}  // namespace sunder::tests::rebar_test
