// Tests of the stress on bonds against the theory of beams, frames and arches.
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/hull.h"
#include "fracture/fracture.h"
#include "fracture/pattern/pattern.h"
#include "fracture/stress/spring_level.h"
#include "fracture/stress/stress_system.h"
#include "tests/fracture/frames.h"

namespace sunder::fracture {
namespace {

TEST(SpringLevel, FindsTheSpringsAtItsNodes) {
  constexpr std::uint32_t kNodes = 3000;
  std::vector<Spring> springs(kNodes);  // A chain that hangs from the world.
  for (std::uint32_t i = 0; i < kNodes; ++i) {
    springs[i] = {i, i > 0 ? i - 1 : Spring::kWorld, Vec3(i, 0, 0), 1, Mat3::Identity()};
  }
  const SpringLevel<double> level(kNodes, springs);
  for (const auto& [first, last] : {std::pair(0u, 0u), {0u, kNodes}, {1024u, 2048u}, {7u, 8u}}) {
    std::vector<int> seen(kNodes, 0);
    level.for_springs_near([&](std::uint32_t node) { return node >= first && node < last; },
                           [&](const Spring& spring) { ++seen[spring.a]; });
    for (std::uint32_t i = 0; i < kNodes; ++i) {
      ASSERT_LE(seen[i], 1) << i;
      const bool has_end_there = i >= first && i <= last && first < last;
      ASSERT_TRUE(seen[i] == 1 || !has_end_there) << i;
    }
    const bool any = std::count(seen.begin(), seen.end(), 1) > 0;
    ASSERT_EQ(any, first < last);
  }
}

TEST(Stress, ACantileversRootStressMatchesBeamTheory) {
  for (const int across : {1, 2, 4}) {
    const double length = 4, width = 0.4;
    const Compound compound = bar(length, width, 10 * across, across);
    const double own = 3 * kDensity * kGravity * length * length / width;
    EXPECT_NEAR(worst_stress(compound).tension_Pa / own, 1, 0.1) << across;

    const auto tip = static_cast<std::uint32_t>(compound.convexes.size() - 1);
    const ConvexLoad load{tip, Vec3(0, -1000, 0), Vec3(length, width / 2, width / 2)};
    const double bending = 6 * 1000 * length / (width * width * width);
    EXPECT_NEAR(worst_stress(compound, {load}, Vec3::Zero()).tension_Pa / bending, 1, 0.1)
        << across;
  }
}

TEST(Stress, ABeamFixedAtBothEndsIsBentMostAtItsEnds) {
  const double length = 6, width = 0.4;
  const Compound compound = bar(length, width, 60, 4, true);
  const double weight = kDensity * kGravity * width * width;  // N/m
  const double expected = weight * length * length / 12 * 6 / (width * width * width);
  EXPECT_NEAR(worst_stress(compound).tension_Pa / expected, 1, 0.1);
}

TEST(Stress, AColumnIsUnderCompressionThatIsHighestAtItsBase) {
  const Compound compound = bar(5, 0.5, 10, 2);
  const BondStress stress = worst_stress(compound, {}, Vec3(-kGravity, 0, 0));
  const double base = kDensity * kGravity * 5;
  EXPECT_NEAR(stress.compression_Pa, base, 1e-2 * base);
  EXPECT_LT(stress.tension_Pa, 1e-2 * base);
}

// Kleinlogel, Rahmenformeln: uniform load w on the beam of a portal fixed at both feet, h its
// height and L its span, all of one section: M = w L² / (6 (h/L + 2)) at the corners.
TEST(Stress, APortalsCornerStressMatchesFrameTheory) {
  const double span = 6, height = 4, t = 0.2;  // Measured between centre lines.
  std::vector<Part> parts;
  const int n = 4;
  const double low = -span / 2 - t / 2, high = span / 2 + t / 2, beam = height - t / 2;
  for (const double x : {low, high - t}) {
    add_grid(Vec3(x, -t / n, 0), Vec3(x + t, 0, t), n, 1, n, true, parts);
    add_grid(Vec3(x, 0, 0), Vec3(x + t, beam, t), n, 39 * n / 2, n, false, parts);
  }
  add_grid(Vec3(low, beam, 0), Vec3(high, beam + t, t), 31 * n, n, n, false, parts);
  const Compound compound = make_compound(std::move(parts));
  // The beam alone is loaded, as in the formula.
  std::vector<ConvexLoad> loads;
  for (std::uint32_t c = 0; c < compound.convexes.size(); ++c) {
    const MassProperties& solid = compound.convexes[c]->solid;
    const double y = solid.centroid.y();
    if (y > beam) loads.push_back({c, kDensity * solid.volume_m3 * kDown, solid.centroid});
  }
  const double w = kDensity * kGravity * t * t;
  const double corner = w * span * span / (6 * (height / span + 2));
  const double middle = w * span * span / 8 - corner;
  const double thrust = 1.5 * corner / height;
  const double expected = middle * 6 / (t * t * t) - thrust / (t * t);
  EXPECT_NEAR(worst_stress(compound, loads, Vec3::Zero()).tension_Pa / expected, 1, 0.1);
}

// A semicircular arch of radius R fixed at both ends, with a load P at the crown. The moment at
// angle θ from there is M = M₀ + H R (1 − cos θ) − ½ P R sin θ; that the crown neither turns nor
// moves sideways, ∫ M dθ = 0 and ∫ M cos θ dθ = 0, gives H = P (4 − π) / (π² − 8) and M₀.
TEST(Stress, AnArchsStressMatchesTheElasticCentreMethod) {
  const double radius = 4, t = 0.2, load_N = 5000;
  const int around = 96, across = 4;
  std::vector<Part> parts;
  const auto ring = [&](int k, double angle_0, double angle_1, bool fixed) {
    const double inner = radius - t / 2 + t * k / across, outer = inner + t / across;
    const SinCos from = sin_cos(angle_0), to = sin_cos(angle_1);
    std::vector<Vec3> corners;
    for (const double r : {inner, outer}) {
      for (const SinCos& at : {from, to}) {
        for (const double z : {0.0, t}) corners.emplace_back(r * at.cos, r * at.sin, z);
      }
    }
    parts.push_back({make_hull(corners), MaterialIndex(fixed ? 1 : 0), fixed});
  };
  const double pi = 3.14159265358979323846, step = pi / around;
  for (int k = 0; k < across; ++k) {
    ring(k, -step, 0, true);
    for (int i = 0; i < around; ++i) ring(k, i * step, (i + 1) * step, false);
    ring(k, pi, pi + step, true);
  }
  const Compound compound = make_compound(std::move(parts));
  std::vector<ConvexLoad> loads;
  for (std::uint32_t c = 0; c < compound.convexes.size(); ++c) {
    const Box& box = compound.convexes[c]->box;
    if (box.min.x() < 1e-6 && box.max.x() > -1e-6 && box.max.y() > radius + 0.4 * t) {
      loads.push_back({c, Vec3::Zero(), Vec3(0, radius + t / 2, t / 2)});
    }
  }
  ASSERT_EQ(loads.size(), 2u);
  for (ConvexLoad& load : loads) load.force_N.y() = -load_N / 2;
  const double thrust = load_N * (4 - pi) / (pi * pi - 8);
  const double crown = load_N * radius / pi - thrust * radius * (1 - 2 / pi);
  const double expected = std::abs(crown) * 6 / (t * t * t) - thrust / (t * t);
  EXPECT_NEAR(worst_stress(compound, loads, Vec3::Zero()).tension_Pa / expected, 1, 0.1);
}

/// Returns a bar from 0 to 4 m along x in Voronoi cells, fixed by a plate at x = 0.
Compound voronoi_bar(int cells, std::uint64_t seed) {
  std::vector<Part> parts;
  add_grid(Vec3(-0.1, 0, 0), Vec3(0, 0.4, 0.4), 1, 1, 1, true, parts);
  add_grid(Vec3::Zero(), Vec3(4, 0.4, 0.4), 1, 1, 1, false, parts);
  const Compound whole = make_compound(std::move(parts));
  const Pattern pattern = voronoi_pattern(cells, 1, true, seed);
  const ImpactSphere everything{Vec3(2, 0.2, 0.2), std::numeric_limits<double>::infinity()};
  BreakPlan plan = fracture(whole, pattern, {Vec3(2.1, 0.7, 0.7).asDiagonal(), Vec3(2, 0.2, 0.2)},
                            everything, 1);
  std::vector<Part> cut;
  for (const Compound& piece : plan.pieces) {
    for (std::size_t c = 0; c < piece.convexes.size(); ++c) {
      const bool fixed = piece.convexes[c]->box.max.x() < 1e-9;
      cut.push_back({piece.convexes[c]->polyhedron, MaterialIndex(fixed ? 1 : 0), fixed});
    }
  }
  return make_compound(std::move(cut), 1e-9);
}

TEST(Stress, ACantileverOfVoronoiCellsIsBentAsOneOfBoxes) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Compound compound = voronoi_bar(1500, seed);
    ASSERT_GT(compound.convexes.size(), 100u);
    const StressSystem system = system_of(compound, stone());
    std::vector<Displacement> displacements;
    const SolveResult solved = system.solve({}, kDown, 1e-3, 500, displacements);
    EXPECT_TRUE(solved.converged);
    double root = 0;  // Stress at the plate.
    for (std::uint32_t i = 0; i < compound.bonds.size(); ++i) {
      if (system.geometry()[i].centroid_R.x() > 1e-6) continue;
      root = std::max(root, system.stress(compound, i, displacements).tension_Pa);
    }
    EXPECT_NEAR(root / (3 * kDensity * kGravity * 16 / 0.4), 1, 0.1) << compound.convexes.size();
  }
}

TEST(Stress, AFreelyFallingBodyHasNoStress) {
  std::vector<Part> parts;
  add_grid(Vec3::Zero(), Vec3(3, 1, 2), 6, 2, 4, false, parts);
  const BondStress stress = worst_stress(make_compound(std::move(parts)));
  EXPECT_LT(stress.tension_Pa + stress.compression_Pa + stress.shear_Pa, 1e-3);
}

// A free rod that is pushed at one end is compressed everywhere by the inertia of its rest.
TEST(Stress, APushedFreeRodIsCompressedByTheInertiaOfItsRest) {
  std::vector<Part> parts;
  add_grid(Vec3::Zero(), Vec3(4, 0.5, 0.5), 8, 1, 1, false, parts);
  const Compound compound = make_compound(std::move(parts));
  const ConvexLoad push{0, Vec3(1000, 0, 0), Vec3(0, 0.25, 0.25)};
  const StressSystem system = system_of(compound, stone());
  std::vector<Displacement> displacements;
  EXPECT_TRUE(system.solve(std::span(&push, 1), kDown, 1e-6, 500, displacements).converged);
  for (std::uint32_t i = 0; i < compound.bonds.size(); ++i) {
    const double rest = (4 - system.geometry()[i].centroid_R.x()) / 4;
    const BondStress stress = system.stress(compound, i, displacements);
    EXPECT_NEAR(stress.compression_Pa, rest * 1000 / 0.25, 1e-3 * 1000 / 0.25);
    EXPECT_LT(stress.tension_Pa, 1e-3 * 1000 / 0.25);
  }
}

TEST(Stress, AWarmStartNeedsNoIterations) {
  const Compound compound = bar(4, 0.4, 30, 3);
  const StressSystem system = system_of(compound, stone());
  std::vector<Displacement> displacements;
  EXPECT_GT(system.solve({}, kDown, 1e-3, 500, displacements).iterations, 0);
  EXPECT_EQ(system.solve({}, kDown, 1e-3, 500, displacements).iterations, 0);
}

TEST(Stress, AGuessWorseThanZeroIsDiscarded) {
  const Compound compound = bar(4, 0.4, 30, 3);
  const StressSystem system = system_of(compound, stone());
  std::vector<Displacement> from_nothing;
  const SolveResult known = system.solve({}, kDown, 1e-3, 500, from_nothing);
  for (const double far_m : {1.0, 1e150, std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<Displacement> displacements(compound.convexes.size());
    for (Displacement& displacement : displacements) displacement.shift_R.y() = far_m;
    const SolveResult result = system.solve({}, kDown, 1e-3, 500, displacements);
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations, known.iterations);
    EXPECT_EQ(displacements[compound.convexes.size() / 2].shift_R,
              from_nothing[compound.convexes.size() / 2].shift_R);
  }
}

TEST(Stress, SpreadOverManySolvesTakesNoMoreIterations) {
  const Compound compound = bar(4, 0.4, 126, 8);
  const StressSystem system = system_of(compound, stone());
  std::vector<Displacement> at_once, spread;
  const int needed = system.solve({}, kDown, 1e-3, 500, at_once).iterations;
  Nodal<double> direction;
  int taken = 0;
  for (bool converged = false; !converged && taken <= needed;) {
    const SolveResult part = system.solve({}, kDown, 1e-3, 2, spread, Vec3::Zero(), &direction);
    converged = part.converged;
    taken += part.iterations;
  }
  EXPECT_GT(needed, 6);
  EXPECT_EQ(taken, needed);
}

TEST(Stress, TakesFewIterationsForManyAndForFlatConvexes) {
  const auto iterations = [](int along, int across) {
    const Compound compound = bar(4, 0.4, along, across);
    std::vector<Displacement> displacements;
    const StressSystem system = system_of(compound, stone());
    return system.solve({}, kDown, 1e-3, 500, displacements).iterations;
  };
  EXPECT_LE(iterations(40, 4), 20);
  EXPECT_LE(iterations(126, 8), 25);
  EXPECT_LE(iterations(20, 20), 30);  // The boxes are ten times as long as thick.
}

TEST(Stress, IsTheSameToTheLastBitForAnyNumberOfThreads) {
  const Compound compound = bar(4, 0.4, 50, 6);
  std::vector<std::vector<Displacement>> results;
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    const StressSystem system = system_of(compound, stone());
    system.solve({}, kDown, 1e-3, 500, results.emplace_back());
  }
  set_threads(0);
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    EXPECT_EQ(results[0][c].shift_R, results[1][c].shift_R);
    EXPECT_EQ(results[0][c].rotation_R, results[2][c].rotation_R);
  }
}

}  // namespace
}  // namespace sunder::fracture
