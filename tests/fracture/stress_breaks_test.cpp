// Tests of bonds broken by steady loads.
#include "fracture/stress/stress_breaks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/hull.h"
#include "fracture/fracture.h"
#include "fracture/solids.h"
#include "tests/fracture/frames.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

constexpr std::uint64_t kUnlimitedWork = std::uint64_t{1} << 40;

/// An answer, and the pieces that its edit leaves; no pieces if the edit changes nothing.
struct Outcome : StressResult {
  std::size_t cut = 0;
  BreakPlan plan = {};
};

Outcome loaded(const Compound& compound, const std::vector<Material>& materials,
               std::vector<AppliedForce> loads = {}, StressCachePtr memory = nullptr,
               std::uint64_t most_work = kUnlimitedWork) {
  Structure structure(compound);
  Outcome outcome{break_by_stress(
      structure, {materials, loads, kDown, Vec3::Zero(), most_work, std::move(memory)})};
  outcome.cut = outcome.edit.cut.size();
  if (outcome.edit.changed || outcome.cut > 0) outcome.plan = apply_edit(structure, outcome.edit);
  return outcome;
}

// The stress at the root of a cantilever is 6 F L / b h².
constexpr double kLength = 4, kWidth = 0.4, kRootStrength = 1e6;
constexpr double kBreakingForce_N = kRootStrength * kWidth * kWidth * kWidth / (6 * kLength);

std::vector<AppliedForce> at_tip(const Compound& bar, double force_N) {
  const ConvexSlot tip(bar.convexes.size() - 1);
  return {{tip, Vec3(0, -force_N, 0), Vec3(kLength, kWidth / 2, kWidth / 2)}};
}

std::vector<Material> weightless(double tensile_Pa) {
  std::vector<Material> materials = stone(tensile_Pa);
  for (Material& material : materials) material.density_kg_m3 = 1e-6;
  return materials;
}

/// Expects that the beam broke off its anchored root, with only a few small pieces beside the root.
void expect_broken_at_root(const BreakPlan& plan) {
  std::size_t all = 0, anchored = 0, longest = 0;
  for (const Compound& piece : plan.pieces) {
    const std::size_t count = piece.convexes.size();
    all += count;
    if (piece.is_anchored()) anchored += count;
    if (!piece.is_anchored()) longest = std::max(longest, count);
  }
  ASSERT_GT(plan.pieces.size(), 1u);
  const double layer = 16;  // Number of convexes in a layer.
  EXPECT_LE(static_cast<double>(anchored), layer);
  EXPECT_GE(static_cast<double>(longest), static_cast<double>(all) - 2 * layer);
  EXPECT_LE(plan.new_area_m2, 1.5 * kWidth * kWidth);
}

TEST(StressBreaks, ACantileverBearsNineTenthsOfItsLoadForeverAndBreaksAtElevenTenths) {
  const Compound compound = bar(kLength, kWidth, 40, 4);
  const std::vector<Material> materials = weightless(kRootStrength);
  StressCachePtr memory;
  for (int step = 0; step < 200; ++step) {
    // A varying load is solved for again each time; its errors must not add up.
    const double load_N = (0.9 + (step % 2 ? 0.01 : -0.01)) * kBreakingForce_N;
    const Outcome answer = loaded(compound, materials, at_tip(compound, load_N), memory);
    ASSERT_TRUE(answer.settled && answer.cut == 0 && answer.plan.pieces.empty()) << step;
    ASSERT_LE(answer.worst, 1);
    memory = answer.memory;
  }
  const Outcome answer =
      loaded(compound, materials, at_tip(compound, 1.1 * kBreakingForce_N), memory);
  EXPECT_TRUE(answer.settled);
  expect_broken_at_root(answer.plan);
}

TEST(StressBreaks, UtilisationIsHighestAtTheRootAndGrowsWithTheLoad) {
  const Compound compound = bar(kLength, kWidth, 40, 4);
  const std::vector<Material> materials = weightless(kRootStrength);
  const Structure structure(compound);
  // Utilisation beyond 1 is reported too, and nothing breaks.
  for (const double part : {0.3, 0.9, 1.5}) {
    const std::vector<AppliedForce> loads = at_tip(compound, part * kBreakingForce_N);
    const std::vector<float> worst = utilisation_by_stress(
        structure, {materials, loads, kDown, Vec3::Zero(), kUnlimitedWork, nullptr});
    ASSERT_EQ(worst.size(), structure.slot_count());
    const auto most = std::ranges::max_element(worst);
    EXPECT_NEAR(double{*most}, part, 0.15 * part);
    const ConvexSlot at(static_cast<std::size_t>(most - worst.begin()));
    EXPECT_LT(structure.convex(at)->solid.centroid.x(), 0.05 * kLength);
    float half_way = 0;  // Half way along the bar, where the moment is half as large.
    structure.for_each([&](ConvexSlot slot, const Convex& convex) {
      const double x = convex.solid.centroid.x() / kLength;
      if (x > 0.48 && x < 0.52) half_way = std::max(half_way, worst[slot.value]);
    });
    EXPECT_NEAR(double{half_way / *most}, 0.5, 0.1);
  }
}

TEST(StressBreaks, BrokenBondsAreExposedOnBothSides) {
  const Compound compound = bar(kLength, kWidth, 40, 4);
  const BreakPlan plan =
      loaded(compound, weightless(kRootStrength), at_tip(compound, 1.1 * kBreakingForce_N)).plan;
  ASSERT_GT(plan.new_area_m2, 0);
  double bare_m2 = 0;
  Vec3 out = Vec3::Zero();
  for (const ExposedFace& exposed : plan.exposed) {
    const ConvexPolyhedron& convex =
        plan.pieces.at(exposed.piece).convexes.at(exposed.convex)->polyhedron;
    EXPECT_LE(exposed.area_m2, face_area(convex, exposed.face) * (1 + 1e-9));
    bare_m2 += exposed.area_m2;
    out += exposed.area_m2 * convex.faces.at(exposed.face).plane.normal;
  }
  EXPECT_NEAR(bare_m2, 2 * plan.new_area_m2, 1e-12);
  EXPECT_LT(out.norm(), 1e-12);
}

TEST(StressBreaks, ACantileverThatIsTooLongBreaksUnderItsSelfWeightAtTheRoot) {
  // A cantilever's self-weight stresses its root by 3 ρ g L² / h.
  const double length = std::sqrt(kRootStrength * kWidth / (3 * kDensity * kGravity));
  EXPECT_EQ(loaded(bar(0.95 * length, kWidth, 30, 4), stone(kRootStrength)).cut, 0u);
  const Outcome answer = loaded(bar(1.05 * length, kWidth, 30, 4), stone(kRootStrength));
  expect_broken_at_root(answer.plan);
}

TEST(StressBreaks, TheSameLoadAgainCostsLittleAndChangesNothing) {
  const Compound compound = bar(kLength, kWidth, 40, 4);
  const Outcome first = loaded(compound, stone(1e9));
  const Outcome second = loaded(compound, stone(1e9), {}, first.memory);
  EXPECT_TRUE(second.settled);
  EXPECT_LT(second.work, first.work / 5);
  EXPECT_EQ(first.worst, second.worst);
}

TEST(StressBreaks, DeferredWorkIsNotLost) {
  const Compound compound = bar(kLength, kWidth, 40, 4);
  const std::vector<Material> materials = weightless(kRootStrength);
  const std::vector<AppliedForce> loads = at_tip(compound, 1.1 * kBreakingForce_N);
  const std::uint64_t little = 3 * compound.bonds.size();
  StressCachePtr memory;
  Compound left = compound;
  std::size_t pieces = 1;
  int calls = 0;
  for (; pieces == 1 && calls < 1000; ++calls) {
    Outcome answer = loaded(left, materials, loads, memory, little);
    EXPECT_LE(answer.work, 130 * compound.bonds.size());
    memory = answer.memory;
    pieces = std::max<std::size_t>(1, answer.plan.pieces.size());
    if (!answer.plan.pieces.empty()) left = answer.plan.pieces[0];
  }
  EXPECT_GT(calls, 3);
  ASSERT_GT(pieces, 1u);
  EXPECT_LE(left.convexes.size(), 32u);  // The beam broke at the root, as in one call.
}

/// Returns half a ring of voussoirs on two footings, without the middle one if `keystone` is false.
Compound arch(bool keystone) {
  const int stones = 15;
  const double pi = 3.14159265358979323846;
  std::vector<Part> parts;
  for (int i = -1; i <= stones; ++i) {
    if (!keystone && i == stones / 2) continue;
    const SinCos from = sin_cos(pi * i / stones), to = sin_cos(pi * (i + 1) / stones);
    std::vector<Vec3> corners;
    for (const double r : {1.7, 2.3}) {
      for (const SinCos& at : {from, to}) {
        for (const double z : {0.0, 0.5}) corners.emplace_back(r * at.cos, r * at.sin, z);
      }
    }
    const bool anchored = i < 0 || i == stones;
    parts.push_back({make_hull(corners), MaterialIndex(anchored ? 1 : 0), anchored});
  }
  return make_compound(std::move(parts));
}

TEST(StressBreaks, AnArchStandsOnlyWithItsKeystone) {
  const std::vector<Material> weak_mortar = stone(1e5);
  EXPECT_EQ(loaded(arch(true), weak_mortar).cut, 0u);
  const Outcome answer = loaded(arch(false), weak_mortar);
  EXPECT_TRUE(answer.settled);
  ASSERT_GE(answer.plan.pieces.size(), 4u);
  int falling = 0;
  for (const Compound& piece : answer.plan.pieces) {
    if (!piece.is_anchored()) falling += static_cast<int>(piece.convexes.size());
  }
  EXPECT_GE(falling, 6);
}

TEST(StressBreaks, UnconnectedPartsBecomePieces) {
  std::vector<Part> parts;
  add_grid(Vec3(0, 0, 0), Vec3(1, 1, 1), 1, 2, 1, true, parts);
  add_grid(Vec3(0, 3, 0), Vec3(1, 4, 1), 2, 1, 1, false, parts);
  const Outcome answer = loaded(make_compound(std::move(parts)), stone(1e6));
  ASSERT_EQ(answer.plan.pieces.size(), 2u);
  EXPECT_TRUE(answer.settled);
  EXPECT_EQ(answer.cut, 0u);
  EXPECT_FALSE(answer.plan.pieces[1].is_anchored());
  EXPECT_EQ(answer.plan.pieces[1].bonds.size(), 1u);
}

TEST(StressBreaks, PartsOnTinyBondsFallOffAndTheRestIsEvaluated) {
  for (const double overlap_m : {1e-6, 1e-5, 1e-4, 1e-3}) {  // Overlap of a block below the tip.
    std::vector<Part> parts;
    add_grid(Vec3(-0.1, 0, 0), Vec3(0, kWidth, kWidth), 1, 4, 4, true, parts);
    add_grid(Vec3::Zero(), Vec3(kLength, kWidth, kWidth), 40, 4, 4, false, parts);
    const Vec3 low(kLength - overlap_m, -0.3, kWidth - overlap_m);
    add_grid(low, low + Vec3(0.3, 0.3, 0.3), 2, 2, 2, false, parts);
    const Compound compound = make_compound(std::move(parts));
    const std::vector<Material> materials = weightless(kRootStrength);
    const Outcome alone = loaded(compound, materials);
    EXPECT_TRUE(alone.settled) << overlap_m;
    ASSERT_EQ(alone.plan.pieces.size(), 2u) << overlap_m;
    EXPECT_EQ(alone.plan.pieces[1].convexes.size(), 8u) << overlap_m;
    const Outcome bent = loaded(alone.plan.pieces[0], materials,
                                at_tip(alone.plan.pieces[0], 1.1 * kBreakingForce_N));
    EXPECT_TRUE(bent.settled) << overlap_m;
    expect_broken_at_root(bent.plan);
  }
}

TEST(StressBreaks, MaterialsWithoutLimitsNeverBreak) {
  const Compound compound = bar(kLength, kWidth, 20, 2);
  EXPECT_EQ(loaded(compound, stone(0), at_tip(compound, 1e12)).cut, 0u);
}

TEST(StressBreaks, AnyCompoundGivesPiecesThatAddUpAndTheSameForAnyNumberOfThreads) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed, 17);
    Compound compound = voronoi_compound(2 + static_cast<int>(random.below(120)), seed);
    for (std::uint8_t& anchored : compound.anchored) anchored = random.uniform() < 0.05;
    std::vector<AppliedForce> loads;
    for (int i = 0; i < 5; ++i) {
      const ConvexSlot convex(random.below(static_cast<std::uint32_t>(compound.convexes.size())));
      const double size = std::pow(10.0, random.uniform(-3, 9));
      loads.push_back(
          {convex, size * random.direction(), random.uniform(0, 9) * random.direction()});
    }
    std::vector<Material> materials = stone(std::pow(10.0, random.uniform(2, 8)));
    materials[0].shear_Pa = std::pow(10.0, random.uniform(2, 8));
    materials[0].compressive_Pa = std::pow(10.0, random.uniform(2, 8));
    std::vector<std::uint64_t> hashes;
    for (const int count : {1, 2, 4}) {
      set_threads(count);
      Outcome answer = loaded(compound, materials, loads);
      for (int more = 0; !answer.settled && more < 50; ++more) {
        if (answer.plan.pieces.size() > 1) break;
        const Compound cracked = answer.plan.pieces[0];
        answer = loaded(cracked, materials, loads, answer.memory);
      }
      EXPECT_TRUE(answer.settled || answer.plan.pieces.size() > 1) << seed;
      EXPECT_TRUE(std::isfinite(answer.worst)) << seed;
      EXPECT_TRUE(!answer.settled || answer.worst <= 1) << seed;
      if (!answer.plan.pieces.empty()) {
        EXPECT_NEAR(total_volume(answer.plan), volume(compound), 1e-9);
      }
      hashes.push_back(combine(hash_of(answer.plan), bits_of(answer.worst)));
    }
    set_threads(0);
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
  }
}

}  // namespace
}  // namespace sunder::fracture
