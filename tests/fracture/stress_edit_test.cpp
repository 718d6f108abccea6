// Test of a stress system that is edited by break after break against one that is rebuilt.
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "fracture/fracture.h"
#include "fracture/pattern/pattern.h"
#include "fracture/solids.h"
#include "tests/fracture/frames.h"

namespace sunder::fracture {
namespace {

/// Returns the indices in `before` of the convexes and bonds of `now`.
StressOrigin origin_of(const Compound& now, const Compound& before) {
  std::map<const Convex*, std::uint32_t> convexes;
  for (std::uint32_t c = 0; c < before.convexes.size(); ++c) {
    convexes[before.convexes[c].get()] = c;
  }
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t>
      bonds;
  for (std::uint32_t i = 0; i < before.bonds.size(); ++i) {
    const Bond& bond = before.bonds[i];
    bonds[{bond.a, bond.b, bond.face_a, bond.face_b}] = i;
  }
  StressOrigin origin;
  for (const ConvexPtr& convex : now.convexes) {
    const auto at = convexes.find(convex.get());
    origin.convexes.push_back(at != convexes.end() ? at->second : StressOrigin::kNew);
  }
  for (const Bond& bond : now.bonds) {
    const auto at =
        bonds.find({origin.convexes[bond.a], origin.convexes[bond.b], bond.face_a, bond.face_b});
    origin.bonds.push_back(at != bonds.end() ? at->second : StressOrigin::kNew);
  }
  return origin;
}

std::vector<BondGeometry> geometry_of(const Compound& compound) {
  std::vector<BondGeometry> geometry;
  for (const Bond& bond : compound.bonds) geometry.push_back(bond_geometry(compound, bond));
  return geometry;
}

/// Returns the stress of every bond, and the number of iterations without a warm start.
std::vector<BondStress> stresses(const Compound& compound, const StressSystem& system,
                                 int& iterations) {
  std::vector<Displacement> displacements;
  const SolveResult result = system.solve({}, kDown, 1e-9, 500, displacements);
  EXPECT_TRUE(result.converged);
  iterations = result.iterations;
  std::vector<BondStress> all;
  for (std::uint32_t i = 0; i < compound.bonds.size(); ++i) {
    all.push_back(system.stress(compound, i, displacements));
  }
  return all;
}

TEST(StressEdit, GivesTheStressesOfARebuiltSystemInSimilarIterations) {
  constexpr int kSide = 14;
  Structure structure(grid_compound(kSide, kSide, kSide, Vec3::Ones(), true));
  Compound compound = structure.compound();
  StressSystem edited(compound, geometry_of(compound), stone(), 400);
  const Pattern pattern = voronoi_pattern(12, 2, false, 1);
  Random random(7, 1);
  for (std::uint64_t event = 1; event <= 8; ++event) {
    const Vec3 at(kSide * random.uniform(), 1 + (kSide - 1) * random.uniform(), kSide);
    const double radius = 1.5;
    structure.apply(
        break_structure(structure, pattern, {radius * Mat3::Identity(), at}, {at, radius}, event));
    const Compound now = structure.compound();
    edited = StressSystem(edited, now, geometry_of(now), stone(), origin_of(now, compound));
    compound = now;
    const StressSystem rebuilt = system_of(compound, stone());
    EXPECT_EQ(edited.work(), rebuilt.work());
    int iterations = 0, iterations_rebuilt = 0;
    const std::vector<BondStress> x = stresses(compound, edited, iterations);
    const std::vector<BondStress> y = stresses(compound, rebuilt, iterations_rebuilt);
    EXPECT_LE(iterations, 1.5 * iterations_rebuilt);
    const double most = kDensity * kGravity * kSide;
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_NEAR(x[i].tension_Pa, y[i].tension_Pa, 1e-5 * most);
      ASSERT_NEAR(x[i].compression_Pa, y[i].compression_Pa, 1e-5 * most);
      ASSERT_NEAR(x[i].shear_Pa, y[i].shear_Pa, 1e-5 * most);
    }
  }
  EXPECT_GT(compound.convexes.size(), 2800u);
}

}  // namespace
}  // namespace sunder::fracture
