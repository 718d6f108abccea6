// Convexes that overlap come apart under load where their strength says so.
#include "fracture/stress/open_overlap.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/geometry/convex_polyhedron.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/stress_breaks.h"
#include "tests/fracture/frames.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40;
constexpr double kStrength_Pa = 1e6;
constexpr MaterialIndex kStone(0);

struct Result {
  Compound stays;
  std::vector<Compound> loose;
};

/// Asks until the answer is settled, as a simulation does; loads act on what is nearest to them
/// until that comes off.
Result under_load(const Compound& compound, std::span<const Material> materials,
                  const std::vector<AppliedForce>& loads, const Vec3& gravity_R) {
  Structure structure(compound);
  Result result;
  StressCachePtr memory;
  for (int step = 0; step < 50; ++step) {
    std::vector<AppliedForce> left;
    for (AppliedForce load : loads) {
      load.convex = nearest(structure, load.point_R);
      if (result.loose.empty()) left.push_back(load);
    }
    const StressResult answer =
        break_by_stress(structure, {materials, left, gravity_R, Vec3::Zero(), kPlenty, memory});
    structure.apply(answer.edit);
    for (const Compound& piece : answer.edit.loose.pieces) result.loose.push_back(piece);
    memory = answer.memory;
    if (answer.settled || structure.empty()) break;
    EXPECT_LT(step, 49) << "never settled";
  }
  result.stays = structure.compound();
  return result;
}

std::vector<Material> weightless() {
  std::vector<Material> materials = stone(kStrength_Pa);
  for (Material& material : materials) material.density_kg_m3 = 1e-6;
  return materials;
}

double volume_of(const Result& result) {
  double sum = result.stays.convexes.empty() ? 0 : volume(result.stays);
  for (const Compound& piece : result.loose) sum += volume(piece);
  return sum;
}

/// A post of 0.4 m x 0.4 m reaches 0.2 m into a slab above it; the slab is held by its top.
Compound slab_and_post(bool post_first) {
  const Part slab{make_box(Vec3(-1, 0, -1), Vec3(1, 0.5, 1)), kStone, anchor_side(1, true)};
  const Part post{make_box(Vec3(-0.2, -1.3, -0.2), Vec3(0.2, 0.2, 0.2)), kStone};
  return post_first ? make_compound({post, slab}) : make_compound({slab, post});
}

class SlabAndPost : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Order, SlabAndPost, testing::Bool(), [](const auto& param) {
  return std::string(param.param ? "PostFirst" : "SlabFirst");
});

TEST_P(SlabAndPost, ThePostIsPulledOutAtItsSectionTimesTheTensileStrength) {
  const Compound compound = slab_and_post(GetParam());
  ASSERT_EQ(compound.ghosts.size(), 1u);
  ASSERT_TRUE(compound.bonds.empty());
  const ConvexSlot post(GetParam() ? 0 : 1);
  const double breaks_N = kStrength_Pa * 0.4 * 0.4;
  const auto loaded = [&](double part) {
    return under_load(compound, weightless(),
                      {{post, Vec3(0, -part * breaks_N, 0), Vec3(0, -1.3, 0)}}, Vec3::Zero());
  };
  const Result held = loaded(0.9), torn = loaded(1.1);
  EXPECT_TRUE(held.loose.empty());
  EXPECT_EQ(held.stays.ghosts.size(), 0u);
  ASSERT_EQ(torn.loose.size(), 1u);
  EXPECT_NEAR(volume(torn.loose[0]), 1.3 * 0.4 * 0.4, 1e-12);
  EXPECT_NEAR(volume_of(torn), volume(compound), 1e-12);
  EXPECT_NEAR(volume_of(held), volume(compound), 1e-12);
}

TEST_P(SlabAndPost, SmallLoadsLeaveTheOverlapAsItIs) {
  const Compound compound = slab_and_post(GetParam());
  const ConvexSlot post(GetParam() ? 0 : 1);
  const Result result = under_load(compound, weightless(),
                                   {{post, Vec3(0, -1e4, 0), Vec3(0, -1.3, 0)}}, Vec3::Zero());
  EXPECT_EQ(result.stays.ghosts.size(), 1u);
  EXPECT_EQ(result.stays.convexes.size(), 2u);
}

TEST_P(SlabAndPost, APostThatIsPressedHoldsMuchMoreThanOneThatIsPulled) {
  const Compound compound = slab_and_post(GetParam());
  const ConvexSlot post(GetParam() ? 0 : 1);
  const Result result =
      under_load(compound, weightless(), {{post, Vec3(0, 4e5, 0), Vec3(0, -1.3, 0)}}, Vec3::Zero());
  EXPECT_TRUE(result.loose.empty());
}

/// A roof of a light and a heavy material on four posts that reach into it.
Compound roof_on_posts(bool roof_first) {
  std::vector<Part> parts;
  for (const double x : {-2.0, 2.0}) {
    for (const double z : {-1.5, 1.5}) {
      const Vec3 foot(x, 0, z);
      parts.push_back({make_box(foot + Vec3(-0.1, 0, -0.1), foot + Vec3(0.1, 2.1, 0.1)),
                       MaterialIndex(0), anchor_side(1, false)});
    }
  }
  Part roof{make_box(Vec3(-2.5, 2, -2), Vec3(2.5, 3, 2)), MaterialIndex(1)};
  parts.insert(roof_first ? parts.begin() : parts.end(), std::move(roof));
  return make_compound(std::move(parts));
}

TEST(OpenOverlap, ARoofHeldByOverlapsAloneFallsWhenItIsTurnedOverAndTooHeavy) {
  for (const bool roof_first : {false, true}) {
    std::vector<Material> materials = stone(kStrength_Pa);
    materials[0].shear_Pa = kStrength_Pa;
    materials[1] = materials[0];
    materials[1].density_kg_m3 = 9000;
    const Compound compound = roof_on_posts(roof_first);
    // The later part is cut: posts below the roof, which then tears off at 0.95 of this load, or
    // the roof around the posts, whose bonds then bend: 0.55.
    const double section_m2 = 4 * 0.2 * 0.2;
    const double roof_kg = 9000 * 5 * 4 * 1.0;
    const double falls_m_s2 = kStrength_Pa * section_m2 / roof_kg;
    const double mass_kg = mass_of(compound, materials).mass_kg;
    const Result held = under_load(compound, materials, {}, Vec3(0, 0.5 * falls_m_s2, 0));
    const Result torn = under_load(compound, materials, {}, Vec3(0, 1.2 * falls_m_s2, 0));
    EXPECT_TRUE(held.loose.empty());
    EXPECT_FALSE(torn.loose.empty());
    for (const Result* result : {&held, &torn}) {
      double kg = mass_of(result->stays, materials).mass_kg;
      for (const Compound& piece : result->loose) kg += mass_of(piece, materials).mass_kg;
      EXPECT_NEAR(kg, mass_kg, 1e-9 * mass_kg) << roof_first;
      EXPECT_NEAR(volume_of(*result), volume(compound), 1e-11) << roof_first;
    }
  }
}

TEST(OpenOverlap, ABeamThroughAWallIsHeldByTheSurfaceInIt) {
  // 0.2 m x 0.2 m, through a wall of 0.3 m: a surface of 0.24 m² in shear.
  const Compound compound = make_compound(
      {{make_box(Vec3(-1, -1, -0.15), Vec3(1, 1, 0.15)), kStone, anchor_side(1, false)},
       {make_box(Vec3(-0.1, -0.1, -1), Vec3(0.1, 0.1, 1)), kStone}});
  std::vector<Material> materials = weightless();
  materials[0].shear_Pa = kStrength_Pa;
  const double slips_N = materials[0].shear_Pa * 4 * 0.2 * 0.3;
  const double snaps_N = kStrength_Pa * 0.2 * 0.2;
  const auto pulled = [&](double force_N) {
    return under_load(compound, materials, {{ConvexSlot(1), Vec3(0, 0, force_N), Vec3(0, 0, 1)}},
                      Vec3::Zero());
  };
  EXPECT_TRUE(pulled(0.5 * std::min(slips_N, snaps_N)).loose.empty());
  const Result torn = pulled(1.2 * (slips_N + snaps_N));
  EXPECT_FALSE(torn.loose.empty());
  EXPECT_NEAR(volume_of(torn), volume(compound), 1e-12);
}

TEST(OpenOverlap, ABarThatEndsFlushWithItsBlockIsHeldByItsSidesAlone) {
  // A bar of 20 mm x 20 mm through a cube of 0.2 m: its sides are 0.016 m², its ends 0.0008 m².
  constexpr MaterialIndex kSteel(1);
  const Compound compound =
      make_compound({{make_box(Vec3(0, 0.16, 0.1), Vec3(0.2, 0.18, 0.12)), kSteel},
                     {make_box(Vec3::Zero(), Vec3::Constant(0.2)), kStone}});
  ASSERT_EQ(compound.ghosts.size(), 1u);
  std::vector<Material> materials = weightless();
  materials[0].shear_Pa = kStrength_Pa;
  materials[1].yield_Pa = 2.5e8;
  const auto utilisation = [&](const Vec3& force_N, const Vec3& moment_Nm) {
    return overlap_utilisation(compound, compound.ghosts[0], {force_N, moment_Nm}, materials);
  };
  EXPECT_NEAR(utilisation(Vec3(8000, 0, 0), Vec3::Zero()), 0.5, 1e-12);
  EXPECT_EQ(utilisation(Vec3::Zero(), Vec3(0, 0, 100)), 0);  // needs no tension
  materials[0].compressive_Pa = 10 * kStrength_Pa;
  const double bends = utilisation(Vec3::Zero(), Vec3(0, 0, 100));
  EXPECT_GT(bends, 0);
  EXPECT_LT(bends, 0.1);
}

TEST(OpenOverlap, OpeningOneOverlapAfterTheOtherKeepsVolumeAndHoldsAllTogether) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    std::vector<Part> parts;
    for (int i = 0; i < 6; ++i) {
      Vec3 corner, size;
      for (int axis = 0; axis < 3; ++axis) corner[axis] = random.uniform(0, 1.2);
      for (int axis = 0; axis < 3; ++axis) size[axis] = random.uniform(0.4, 1.5);
      parts.push_back({make_box(corner, corner + size), MaterialIndex(i % 2), 0});
    }
    const Compound compound = make_compound(std::move(parts));
    const std::vector<std::uint32_t> islands = find_islands(compound);
    std::vector<Material> materials = stone(kStrength_Pa);
    materials.push_back(materials[0]);
    materials[1].density_kg_m3 = 100;
    const double kg = mass_of(compound, materials).mass_kg, m3 = volume(compound);
    Structure structure(compound);
    for (int opened = 0; opened < 200; ++opened) {
      const Compound now = structure.compound();
      const auto pair =
          std::ranges::find(now.ghosts, 2u, [](const Ghost& g) { return g.of.size(); });
      if (pair == now.ghosts.end()) break;
      const std::vector<ConvexSlot> slots = structure.slots();
      structure.apply(open_overlap(structure, slots[pair->of[0]], slots[pair->of[1]]));
      const Compound after = structure.compound();
      ASSERT_NEAR(volume(after), m3, 1e-9) << seed;
      ASSERT_NEAR(mass_of(after, materials).mass_kg, kg, 1e-9 * kg) << seed;
    }
    const Compound after = structure.compound();
    EXPECT_TRUE(after.ghosts.empty()) << seed;
    EXPECT_EQ(std::ranges::max(find_islands(after)), std::ranges::max(islands)) << seed;
  }
}

}  // namespace
}  // namespace sunder::fracture
