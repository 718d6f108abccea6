// What a blow breaks: where the stress is, by its impulse and the inertia of what is struck. How
// fast a ball has to be at each preset is a truth (bench/truths/blows.cpp).
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/hull.h"
#include "fracture/stress/stress_breaks.h"
#include "tests/fracture/frames.h"

namespace sunder::fracture {
namespace {

constexpr double kStrength = 3e6, kLong = 4, kWide = 0.4;  // Pa; a bar's length and width, m
constexpr double kYoungs = 3e10, kStiffness = 3 * kYoungs * kWide * kWide * kWide * kWide / 12 /
                                              (kLong * kLong * kLong);  // of its tip, N/m
constexpr double kSwings_kg = kDensity * kWide * kWide * kLong * 33 / 140;
const Vec3 kTip(kLong, kWide, kWide / 2);

/// What a ball of that mass and speed, that does not bounce, does where it lands.
StressResult struck(const Compound& compound, double kg, double m_s, double reach_m = 0,
                    const Vec3& at_R = kTip, double toughness_J_m2 = 0,
                    std::uint64_t most_work = std::uint64_t{1} << 40,
                    const StressCachePtr& memory = nullptr) {
  std::vector<Material> materials = stone(kStrength);
  materials[0].youngs_Pa = kYoungs;
  materials[0].toughness_J_m2 = toughness_J_m2;
  std::size_t nearest = 0;
  const auto distance = [&](std::size_t c) {
    return (compound.convexes[c]->solid.centroid - at_R).norm();
  };
  for (std::size_t c = 0; c < compound.convexes.size(); ++c)
    if (distance(c) < distance(nearest)) nearest = c;
  const AppliedForce impulse{ConvexSlot(nearest), Vec3(0, -kg * m_s, 0), at_R};
  LoadCase load;
  load.materials = materials;
  load.most_work = most_work;
  load.memory = memory;
  load.blow = {std::span(&impulse, 1), 0.5 * kg * m_s * m_s, at_R, reach_m, std::uint64_t{1} << 40};
  return break_by_stress(Structure(compound), load);
}

/// Cox (1849): the ball that just breaks the root.
double breaking_m_s(double kg) {
  const double force_N = kStrength * kWide * kWide * kWide / (6 * kLong);
  return force_N * std::sqrt((kg + kSwings_kg) / kStiffness) / kg;
}

TEST(ImpulsiveLoad, ACantileverStruckAtItsTipSnapsAtItsRootWhateverStrikesIt) {
  for (const int across : {2, 4, 6}) {
    const Compound compound = bar(kLong, kWide, 10 * across, across);
    for (const double kg : {2.0, 40.0, 20000.0}) {
      const double m_s = breaking_m_s(kg);
      const StressResult holds = struck(compound, kg, 0.95 * m_s);
      EXPECT_TRUE(holds.edit.cut.empty());
      EXPECT_NEAR(holds.blow.worst, 0.95, 0.02) << across << " across, " << kg << " kg";
      const StressResult breaks = struck(compound, kg, 1.05 * m_s);
      EXPECT_TRUE(breaks.edit.changed);
      EXPECT_NEAR(breaks.edit.loose.new_area_m2, kWide * kWide, 1e-9);
      for (const Bond& bond : breaks.edit.cut)
        EXPECT_NEAR(compound.convexes[bond.b]->box.min.x(), 0, 1e-9) << "at the root";
    }
  }
}

TEST(ImpulsiveLoad, IsDecidedInSeveralAnswersAsInOne) {
  const Compound compound = bar(kLong, kWide, 60, 6);
  const double kg = 40, m_s = breaking_m_s(kg);
  const StressResult holds = struck(compound, kg, 0.95 * m_s);
  for (const double times : {0.95, 1.05}) {
    const StressResult once = struck(compound, kg, times * m_s);
    EXPECT_FALSE(once.undecided);
    StressResult answer;
    int answers = 1;
    while (true) {
      answer = struck(compound, kg, times * m_s, 0, kTip, 0, holds.work / 8, answer.memory);
      if (!answer.undecided || ++answers == 100) break;
      EXPECT_TRUE(answer.edit.cut.empty());
    }
    EXPECT_GE(answers, 2);
    EXPECT_LT(answers, 20);
    EXPECT_NEAR(answer.blow.worst, once.blow.worst, 0.02 * once.blow.worst);
    EXPECT_EQ(answer.edit.cut.empty(), once.edit.cut.empty());
  }
}

TEST(ImpulsiveLoad, IsGivenUpAfterItsWork) {
  const Compound compound = bar(kLong, kWide, 60, 6);
  const StressResult once = struck(compound, 40, 0.5 * breaking_m_s(40));
  std::vector<Material> materials = stone(kStrength);
  const AppliedForce impulse{ConvexSlot(0), Vec3(0, -1, 0), kTip};
  LoadCase load;
  load.materials = materials;
  load.most_work = once.work / 20;
  load.blow = {std::span(&impulse, 1), 1, kTip, 0, once.work / 2};
  int answers = 0;
  for (StressResult answer; (answer = break_by_stress(Structure(compound), load)).undecided;) {
    load.memory = answer.memory;
    ASSERT_LT(++answers, 12);
  }
}

TEST(ImpulsiveLoad, OnASlabCrushesTheColumnThatBearsMost) {
  constexpr double kApart = 2, kHigh = 1, kThick = 0.2;
  std::vector<Part> parts;
  for (const double x : {0.0, kApart, 2 * kApart}) {
    add_grid(Vec3(x, -0.1, 0), Vec3(x + kWide, 0, kWide), 4, 1, 4, true, parts);
    add_grid(Vec3(x, 0, 0), Vec3(x + kWide, kHigh, kWide), 4, 10, 4, false, parts);
  }
  const std::size_t columns = parts.size();
  add_grid(Vec3(0, kHigh, 0), Vec3(2 * kApart + kWide, kHigh + kThick, kWide), 44, 2, 4, false,
           parts);
  for (std::size_t c = columns; c < parts.size(); ++c) parts[c].material = MaterialIndex(2);
  const Compound compound = make_compound(std::move(parts));
  std::vector<Material> materials = stone();
  materials[0].youngs_Pa = kYoungs;
  materials.push_back(materials[0]);  // of the slab, which holds
  materials[0].compressive_Pa = 2e6;
  const auto top = [&](double x) {
    std::uint32_t nearest = 0;
    const Vec3 at(x, kHigh + kThick, kWide / 2);
    for (std::uint32_t c = 1; c < compound.convexes.size(); ++c)
      if ((compound.convexes[c]->solid.centroid - at).norm() <
          (compound.convexes[nearest]->solid.centroid - at).norm())
        nearest = c;
    return AppliedForce{ConvexSlot(nearest), Vec3(0, -1, 0), at};
  };
  // A blow between two columns, and a steady load over a third of what crushes one of them.
  for (const double loaded : {0.0, kApart, 2 * kApart}) {
    AppliedForce steady = top(loaded + kWide / 2);
    steady.force_N *= 0.4 * 2e6 * kWide * kWide;
    AppliedForce impulse =
        top(loaded < 2 * kApart ? kApart / 2 + kWide / 2 : 1.5 * kApart + kWide / 2);
    const double kg = 3e4, m_s = 0.01;
    impulse.force_N *= kg * m_s;
    LoadCase load;
    load.materials = materials;
    load.loads = std::span(&steady, 1);
    load.most_work = std::uint64_t{1} << 40;
    load.blow = {std::span(&impulse, 1), 0.5 * kg * m_s * m_s, impulse.point_R, 0};
    const ImpulsiveStress blow = break_by_stress(Structure(compound), load).blow;
    EXPECT_NEAR(blow.worst_R.x(), loaded + kWide / 2, kWide / 2) << blow.worst;
    EXPECT_LE(blow.worst_R.y(), kHigh + 1e-9);
  }
}

TEST(ImpulsiveLoad, StaysWhereItLandsTheMoreTheLighterWhatStrikes) {
  const Compound compound = bar(kLong, kWide, 40, 4);
  for (const double kg : {1.0, 100.0, 1e4}) {
    const StressResult answer = struck(compound, kg, 1e-3);
    EXPECT_NEAR(answer.blow.local, kSwings_kg / (kSwings_kg + kg), 0.01) << kg;
    // What is bent within half a metre of the tip: (l / L)³ of what a cantilever holds, but for
    // where the blow presses.
    const double near = struck(compound, kg, 1e-3, 0.5).blow.local;
    EXPECT_GE(near, answer.blow.local);
    EXPECT_NEAR(near, answer.blow.local, 0.02);
    EXPECT_NEAR(struck(compound, kg, 1e-3, 100).blow.local, 1, 1e-3);
  }
}

TEST(ImpulsiveLoad, OnWhatFliesBendsItAgainstItsInertiaAlone) {
  // Struck in its middle it is bent as two cantilevers by their own inertia: M = F L / 8 there.
  std::vector<Part> parts;
  add_grid(Vec3::Zero(), Vec3(kLong, kWide, kWide), 40, 4, 4, false, parts);
  const Compound rod = make_compound(std::move(parts));
  const Vec3 middle(kLong / 2 + 0.01, kWide, kWide / 2);
  const StressResult answer = struck(rod, 1e6, 0.01, 0, middle);
  EXPECT_NEAR(answer.blow.worst_R.x(), kLong / 2, 0.11);
  EXPECT_TRUE(struck(rod, 1e6, 0, 0, middle).edit.cut.empty()) << "no blow";
}

TEST(ImpulsiveLoad, ThatCracksSpendsItsEnergyOnEachBond) {
  const Compound compound = bar(kLong, kWide, 40, 4);
  const double kg = 2000, m_s = 2 * breaking_m_s(kg), energy_J = 0.5 * kg * m_s * m_s;
  EXPECT_EQ(struck(compound, kg, m_s).edit.cut.size(), 16u);
  // For the whole section; its other side is a foundation, which takes nothing.
  const double all_J_m2 = energy_J / (kWide * kWide);
  const std::size_t cut = struck(compound, kg, m_s, 0, kTip, 4 * all_J_m2).edit.cut.size();
  EXPECT_GT(cut, 0u);
  EXPECT_LT(cut, 16u) << "it comes to rest in a crack";
}

TEST(ImpulsiveLoad, IsTheSameToTheLastBitForAnyNumberOfThreads) {
  const Compound compound = bar(kLong, kWide, 60, 6);
  std::vector<ImpulsiveStress> blows;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    blows.push_back(struck(compound, 40, 3).blow);
  }
  set_threads(0);
  for (const ImpulsiveStress& blow : blows) {
    EXPECT_EQ(blow.worst, blows[0].worst);
    EXPECT_EQ(blow.local, blows[0].local);
    EXPECT_EQ(blow.worst_R, blows[0].worst_R);
  }
}

}  // namespace
}  // namespace sunder::fracture
