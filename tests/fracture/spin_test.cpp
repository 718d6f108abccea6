// Tests of stress by spin against closed forms.
#include <gtest/gtest.h>

#include "engine/geometry/hull.h"
#include "tests/fracture/frames.h"

namespace sunder::fracture {
namespace {

constexpr double kPi = 3.14159265358979323846;

BondStress spin_stress(const Compound& compound, const Vec3& spin_rad_s) {
  const StressSystem system = system_of(compound, stone());
  std::vector<Displacement> displacements;
  EXPECT_TRUE(system.solve({}, Vec3::Zero(), 1e-6, 500, displacements, spin_rad_s).converged);
  return worst_stress(compound, system, displacements);
}

Compound rod(double length_m, double width_m, int along, int across) {
  std::vector<Part> parts;
  add_grid(Vec3::Zero(), Vec3(length_m, width_m, width_m), along, across, across, false, parts);
  return make_compound(std::move(parts));
}

/// Returns a wheel about y, of wedges in rings.
Compound wheel(double inner_m, double outer_m, double thickness_m, int rings, int wedges) {
  std::vector<Part> parts;
  for (int r = 0; r < rings; ++r) {
    for (int i = 0; i < wedges; ++i) {
      std::vector<Vec3> corners;
      for (int end = 0; end < 2; ++end) {
        const SinCos a = sin_cos(2 * kPi * ((i + end) % wedges) / wedges);
        for (const int side : {r, r + 1}) {
          const double radius_m = inner_m + (outer_m - inner_m) * side / rings;
          for (const double y : {0.0, thickness_m})
            corners.emplace_back(radius_m * a.cos, y, radius_m * a.sin);
        }
      }
      parts.push_back({make_hull(corners), MaterialIndex(0), false});
    }
  }
  return make_compound(std::move(parts));
}

TEST(Spin, StressesARodByItsLengthAndSpin) {
  const double length = 4, omega = 30;
  const double middle = kDensity * omega * omega * length * length / 8;
  for (const int across : {1, 2}) {
    const BondStress stress = spin_stress(rod(length, 0.2, 40, across), Vec3(0, omega, 0));
    EXPECT_NEAR(stress.tension_Pa / middle, 1, 0.02) << across;
    EXPECT_LT(stress.compression_Pa, 0.01 * middle);
  }
}

// A straight rod that tumbles freely is under tension only, by the component of its spin across the
// rod; the rest of the centrifugal force rotates the rod's axis. This holds for any number of
// convexes, although their own inertia resists rotation.
TEST(Spin, StressesATumblingRodByTensionOnly) {
  const double length = 4, omega = 30;
  for (const int along : {2, 8, 40}) {
    for (const double angle : {0.3, 0.8, 1.3}) {
      const SinCos lean = sin_cos(angle);
      const double across = omega * lean.sin;
      const BondStress stress =
          spin_stress(rod(length, 0.1, along, 1), omega * Vec3(lean.cos, lean.sin, 0));
      const double middle = kDensity * across * across * length * length / 8;
      EXPECT_NEAR(stress.tension_Pa / middle, 1, 0.03) << along << " " << angle;
      EXPECT_LT(stress.compression_Pa, 0.02 * middle) << along << " " << angle;
    }
  }
}

TEST(Spin, StressesARingByItsRimSpeed) {
  const double omega = 30, radius = 1;
  const BondStress stress = spin_stress(wheel(0.95, 1.05, 0.1, 1, 32), Vec3(0, omega, 0));
  EXPECT_NEAR(stress.tension_Pa / (kDensity * omega * omega * radius * radius), 1, 0.03);
}

// Half of a disc with a hole pulls on the other half with 2/3 ρ ω² h (r³ − a³). In a thick ring,
// Lamé's equations give more beside the hole and less at the rim: (3 r² + a²)/4 of ρ ω² at the
// hole's edge for ν = 0, as for independent springs.
TEST(Spin, StressesADiscMostAtItsHole) {
  const double omega = 30, radius = 1, hole = 0.4;
  const double edge = kDensity * omega * omega * (3 * radius * radius + hole * hole) / 4;
  const BondStress stress = spin_stress(wheel(hole, radius, 0.1, 12, 48), Vec3(0, omega, 0));
  EXPECT_NEAR(stress.tension_Pa / edge, 1, 0.1);
}

TEST(Spin, DoesNotStressAnAnchoredBar) {
  const BondStress stress = spin_stress(bar(4, 0.4, 20, 1), Vec3(0, 30, 0));
  EXPECT_LT(stress.tension_Pa + stress.compression_Pa + stress.shear_Pa, 1e-3);
}

}  // namespace
}  // namespace sunder::fracture
