// Tests of bonds broken by impact loads: where the stress is, by the impulse and the inertia of the
// struck solid. Row 36 of docs/truths.md has the speeds of a ball that break at each preset.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/hull.h"
#include "fracture/stress/stress_breaks.h"
#include "tests/fracture/frames.h"

namespace sunder::fracture {
namespace {

// Strength in Pa; length and width of a bar in m; stiffness of its tip in N/m.
constexpr double kStrength = 3e6, kBarLength = 4, kBarWidth = 0.4;
constexpr double kYoungs = 3e10, kStiffness = 3 * kYoungs * kBarWidth * kBarWidth * kBarWidth *
                                              kBarWidth / 12 /
                                              (kBarLength * kBarLength * kBarLength);
constexpr double kEffectiveMass_kg = kDensity * kBarWidth * kBarWidth * kBarLength * 33 / 140;
const Vec3 kTip(kBarLength, kBarWidth, kBarWidth / 2);

/// Returns the answer for a ball of that mass and speed that strikes a point and does not bounce.
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
  load.impulsive_load = {std::span(&impulse, 1), 0.5 * kg * m_s * m_s, at_R, reach_m,
                         std::uint64_t{1} << 40};
  return break_by_stress(Structure(compound), load);
}

/// Returns the speed of a ball that just breaks the root (Cox 1849).
double breaking_speed_m_s(double kg) {
  const double force_N = kStrength * kBarWidth * kBarWidth * kBarWidth / (6 * kBarLength);
  return force_N * std::sqrt((kg + kEffectiveMass_kg) / kStiffness) / kg;
}

TEST(ImpactLoad, ACantileverStruckAtItsTipBreaksAtItsRootForAnyStriker) {
  for (const int across : {2, 4, 6}) {
    const Compound compound = bar(kBarLength, kBarWidth, 10 * across, across);
    for (const double kg : {2.0, 40.0, 20000.0}) {
      const double m_s = breaking_speed_m_s(kg);
      const StressResult holds = struck(compound, kg, 0.95 * m_s);
      EXPECT_TRUE(holds.edit.cut.empty());
      EXPECT_NEAR(holds.impulsive_stress.worst, 0.95, 0.02) << across << " across, " << kg << " kg";
      const StressResult breaks = struck(compound, kg, 1.05 * m_s);
      EXPECT_TRUE(breaks.edit.changed);
      EXPECT_NEAR(breaks.edit.loose.new_area_m2, kBarWidth * kBarWidth, 1e-9);
      for (const Bond& bond : breaks.edit.cut)
        EXPECT_NEAR(compound.convexes[bond.b]->box.min.x(), 0, 1e-9) << "at the root";
    }
  }
}

TEST(ImpactLoad, IsDecidedInSeveralCallsAsInOne) {
  const Compound compound = bar(kBarLength, kBarWidth, 60, 6);
  const double kg = 40, m_s = breaking_speed_m_s(kg);
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
    EXPECT_NEAR(answer.impulsive_stress.worst, once.impulsive_stress.worst,
                0.02 * once.impulsive_stress.worst);
    EXPECT_EQ(answer.edit.cut.empty(), once.edit.cut.empty());
  }
}

TEST(ImpactLoad, IsAbandonedAfterItsWorkLimit) {
  const Compound compound = bar(kBarLength, kBarWidth, 60, 6);
  const StressResult once = struck(compound, 40, 0.5 * breaking_speed_m_s(40));
  std::vector<Material> materials = stone(kStrength);
  const AppliedForce impulse{ConvexSlot(0), Vec3(0, -1, 0), kTip};
  LoadCase load;
  load.materials = materials;
  load.most_work = once.work / 20;
  load.impulsive_load = {std::span(&impulse, 1), 1, kTip, 0, once.work / 2};
  int answers = 0;
  StressResult answer;
  while ((answer = break_by_stress(Structure(compound), load)).undecided) {
    EXPECT_FALSE(answer.gave_up);
    load.memory = answer.memory;
    ASSERT_LT(++answers, 12);
  }
  EXPECT_TRUE(answer.gave_up);
  EXPECT_FALSE(once.gave_up);
}

TEST(ImpactLoad, OnASlabCrushesTheMostLoadedColumn) {
  constexpr double kApart = 2, kHigh = 1, kThick = 0.2;
  std::vector<Part> parts;
  for (const double x : {0.0, kApart, 2 * kApart}) {
    add_grid(Vec3(x, -0.1, 0), Vec3(x + kBarWidth, 0, kBarWidth), 4, 1, 4, true, parts);
    add_grid(Vec3(x, 0, 0), Vec3(x + kBarWidth, kHigh, kBarWidth), 4, 10, 4, false, parts);
  }
  const std::size_t columns = parts.size();
  add_grid(Vec3(0, kHigh, 0), Vec3(2 * kApart + kBarWidth, kHigh + kThick, kBarWidth), 44, 2, 4,
           false, parts);
  for (std::size_t c = columns; c < parts.size(); ++c) parts[c].material = MaterialIndex(2);
  const Compound compound = make_compound(std::move(parts));
  std::vector<Material> materials = stone();
  materials[0].youngs_Pa = kYoungs;
  materials.push_back(materials[0]);  // The material of the slab, which does not break.
  materials[0].compressive_Pa = 2e6;
  const auto top = [&](double x) {
    std::uint32_t nearest = 0;
    const Vec3 at(x, kHigh + kThick, kBarWidth / 2);
    for (std::uint32_t c = 1; c < compound.convexes.size(); ++c)
      if ((compound.convexes[c]->solid.centroid - at).norm() <
          (compound.convexes[nearest]->solid.centroid - at).norm())
        nearest = c;
    return AppliedForce{ConvexSlot(nearest), Vec3(0, -1, 0), at};
  };
  // An impact between two columns, and a steady load of over a third of the strength of one.
  for (const double loaded : {0.0, kApart, 2 * kApart}) {
    AppliedForce steady = top(loaded + kBarWidth / 2);
    steady.force_N *= 0.4 * 2e6 * kBarWidth * kBarWidth;
    AppliedForce impulse =
        top(loaded < 2 * kApart ? kApart / 2 + kBarWidth / 2 : 1.5 * kApart + kBarWidth / 2);
    const double kg = 3e4, m_s = 0.01;
    impulse.force_N *= kg * m_s;
    LoadCase load;
    load.materials = materials;
    load.loads = std::span(&steady, 1);
    load.most_work = std::uint64_t{1} << 40;
    load.impulsive_load = {std::span(&impulse, 1), 0.5 * kg * m_s * m_s, impulse.point_R, 0};
    const ImpulsiveStress blow = break_by_stress(Structure(compound), load).impulsive_stress;
    EXPECT_NEAR(blow.worst_R.x(), loaded + kBarWidth / 2, kBarWidth / 2) << blow.worst;
    EXPECT_LE(blow.worst_R.y(), kHigh + 1e-9);
  }
}

TEST(ImpactLoad, IsMoreLocalForALighterStriker) {
  const Compound compound = bar(kBarLength, kBarWidth, 40, 4);
  for (const double kg : {1.0, 100.0, 1e4}) {
    const StressResult answer = struck(compound, kg, 1e-3);
    EXPECT_NEAR(answer.impulsive_stress.local, kEffectiveMass_kg / (kEffectiveMass_kg + kg), 0.01)
        << kg;
    // The share of the strain energy within l = 0.5 m of the tip is (l / L)³ for a cantilever,
    // except near the impact.
    const double near = struck(compound, kg, 1e-3, 0.5).impulsive_stress.local;
    EXPECT_GE(near, answer.impulsive_stress.local);
    EXPECT_NEAR(near, answer.impulsive_stress.local, 0.02);
    EXPECT_NEAR(struck(compound, kg, 1e-3, 100).impulsive_stress.local, 1, 1e-3);
  }
}

TEST(ImpactLoad, OnAFreeRodBendsItAgainstItsInertia) {
  // A rod struck in its middle is bent as two cantilevers by their own inertia: M = F L / 8 there.
  std::vector<Part> parts;
  add_grid(Vec3::Zero(), Vec3(kBarLength, kBarWidth, kBarWidth), 40, 4, 4, false, parts);
  const Compound rod = make_compound(std::move(parts));
  const Vec3 middle(kBarLength / 2 + 0.01, kBarWidth, kBarWidth / 2);
  const StressResult answer = struck(rod, 1e6, 0.01, 0, middle);
  EXPECT_NEAR(answer.impulsive_stress.worst_R.x(), kBarLength / 2, 0.11);
  EXPECT_TRUE(struck(rod, 1e6, 0, 0, middle).edit.cut.empty()) << "no impact";
}

TEST(ImpactLoad, SpendsItsEnergyOnEachBrokenBond) {
  const Compound compound = bar(kBarLength, kBarWidth, 40, 4);
  const double kg = 2000, m_s = 2 * breaking_speed_m_s(kg), energy_J = 0.5 * kg * m_s * m_s;
  EXPECT_EQ(struck(compound, kg, m_s).edit.cut.size(), 16u);
  // Toughness of the whole section; its other side is a foundation, which takes no energy.
  const double all_J_m2 = energy_J / (kBarWidth * kBarWidth);
  const std::size_t cut = struck(compound, kg, m_s, 0, kTip, 4 * all_J_m2).edit.cut.size();
  EXPECT_GT(cut, 0u);
  EXPECT_LT(cut, 16u) << "the impact's energy ends within the section";
}

TEST(ImpactLoad, IsTheSameToTheLastBitForAnyNumberOfThreads) {
  const Compound compound = bar(kBarLength, kBarWidth, 60, 6);
  std::vector<ImpulsiveStress> blows;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    blows.push_back(struck(compound, 40, 3).impulsive_stress);
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
