// Tests of blasts of charges: the impulse of a blast wave against published tables, and the
// momentum it gives to plates.
#include "engine/world/act/charge.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/exponential.h"
#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

TEST(Exponential, AndLogarithmAreThoseOfTheLibrary) {
  double power = 0, log = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = -700 + 0.14 * i, y = std::exp(0.9 * x);
    power = std::max(power, std::abs(exponential(x) / std::exp(x) - 1) / (1 + std::abs(x)));
    log = std::max(
        log, std::abs(natural_logarithm(y) - std::log(y)) / std::max(1.0, std::abs(std::log(y))));
  }
  EXPECT_LT(power, 1e-15);
  EXPECT_LT(log, 1e-15);
}

TEST(Charge, OnTheGroundHasTheImpulsesOfPublishedTables) {
  struct Row {
    double z, incident, reflected;  // distance in m, impulses in Pa·s; 1 kg of TNT
  };
  // Source: Swisdak 1994, table 3 (metric).
  const Row swisdak[] = {{0.2, 369.5, 10520}, {0.5, 166.2, 2371}, {0.8, 201.5, 1201},
                         {0.9, 223.9, 1021},  {1, 236.3, 884.7},  {1.5, 177.4, 520.7},
                         {2, 134.6, 363.8},   {3, 92.7, 224.3},   {5, 59.31, 125.6},
                         {10, 31.04, 59.33},  {20, 15.89, 28.67}, {40, 7.885, 13.85}};
  double worst = 0;
  const auto compare = [&](double tnt_kg, const Row& row, double bound) {
    const WaveImpulse wave = wave_impulse(tnt_kg, BurstKind::kGround, row.z);
    EXPECT_NEAR(wave.reflected_Pa_s / row.reflected, 1, bound) << row.z;
    EXPECT_NEAR(wave.incident_Pa_s / row.incident, 1, bound) << row.z;
    worst = std::max({worst, std::abs(wave.reflected_Pa_s / row.reflected - 1),
                      std::abs(wave.incident_Pa_s / row.incident - 1)});
  };
  for (const Row& row : swisdak) compare(1, row, 0.006);
  // Source: IATG 01.80, table 5: at 50 m, in bar·ms.
  compare(1e5, {50, 106e2, 372e2}, 0.006);
  compare(1e4, {50, 25.2e2, 65.5e2}, 0.006);
  compare(1e3, {50, 5.9e2, 12.6e2}, 0.006);
  std::printf("impulses of charges on the ground: %.2f %% off tables at most\n", 100 * worst);
}

TEST(Charge, InTheAirHasTheImpulsesOfTheFitsForSphericalBursts) {
  // Source: Kingery and Bulmash 1984, spherical, metric: log10 i_r by U = -0.204 + 1.3788 log10 Z.
  double worst = 0;
  for (double z = 0.1; z < 32; z *= 1.2) {
    const double u = -0.204004553231 + 1.37882996018 * std::log10(z);
    const double reflected = std::pow(
        10, 2.55875660396 + u * (-0.903118886091 + u * (0.101771877942 - 0.0242139751146 * u)));
    const double found = wave_impulse(1, BurstKind::kAir, z).reflected_Pa_s;
    worst = std::max(worst, std::abs(found / reflected - 1));
  }
  std::printf("impulses of charges in the air: %.2f %% off their own fit at most\n", 100 * worst);
  EXPECT_LT(worst, 0.015);
  EXPECT_NEAR(wave_impulse(1, BurstKind::kAir, 1).incident_Pa_s, 174.54, 0.01 * 174.54);
}

TEST(Charge, HasTheImpulseOfTheNearestScaledDistanceWithinItAndNoneOutOfReach) {
  const double nearest = wave_impulse(8, BurstKind::kGround, 2 * 0.0674).reflected_Pa_s;
  EXPECT_EQ(wave_impulse(8, BurstKind::kGround, 0.01).reflected_Pa_s, nearest);
  EXPECT_DOUBLE_EQ(wave_reach_m(8, BurstKind::kGround), 80);
  EXPECT_GT(wave_impulse(8, BurstKind::kGround, 79.9).reflected_Pa_s, 0);
  EXPECT_EQ(wave_impulse(8, BurstKind::kGround, 80.1).reflected_Pa_s, 0);
  // The two fits of the incident impulse meet.
  EXPECT_NEAR(wave_impulse(1, BurstKind::kGround, 0.95499).incident_Pa_s /
                  wave_impulse(1, BurstKind::kGround, 0.95501).incident_Pa_s,
              1, 0.006);
}

/// Returns a scene of a charge at the origin and a plate of 1000 kg/m³ across x, whose near face is
/// at x = `distance_m`, turned about z.
Scene plate_scene(double distance_m, double half_m, double thick_m, double tnt_kg,
                  double turn_rad = 0) {
  Scene scene;
  Material stone;
  stone.density_kg_m3 = 1000;
  scene.materials = {stone};
  scene.gravity_W = Vec3::Zero();
  scene.accuracy = {1.0 / 60, 1};
  Solid plate;
  plate.compound.convexes.push_back(make_convex(
      make_box(Vec3(0, -half_m, -half_m), Vec3(thick_m, half_m, half_m)), MaterialIndex(0)));
  plate.compound.anchored.push_back(0);
  plate.X_WR.position = Vec3(distance_m, 0, 0);
  plate.X_WR.rotation = Quat(std::cos(turn_rad / 2), 0, 0, std::sin(turn_rad / 2));
  scene.solids = {plate};
  Blast blast;
  blast.tnt_kg = tnt_kg;
  scene.blasts = {blast};
  return scene;
}

/// Returns the momentum of the scene's first solid after six frames, in N s.
Vec3 momentum_of(const Scene& scene) {
  auto owned = std::make_unique<ScriptedPhysics>(
      [](const ScriptedPhysics&, int) { return std::vector<SpeculativeContact>(); });
  ScriptedPhysics* physics = owned.get();
  Simulation simulation(scene, std::move(owned), std::make_unique<ScriptedBreaker>(1));
  for (int i = 0; i < 6; ++i) simulation.next();
  const Box box = bounds(scene.solids[0].compound);
  return 1000 * box.extent().prod() * physics->find(0)->state.velocity_W;
}

TEST(Charge, GivesAPlateItsReflectedImpulseTimesItsArea) {
  for (const double distance_m : {0.5, 2.0, 10.0}) {
    const double half_m = 0.02 * distance_m, area_m2 = 4 * half_m * half_m;
    const Vec3 momentum = momentum_of(plate_scene(distance_m, half_m, 0.1, 1));
    const double expected =
        wave_impulse(1, BurstKind::kGround, distance_m).reflected_Pa_s * area_m2;
    std::printf("plate at %g m of 1 kg: %.5g N·s, i_r·A is %.5g\n", distance_m, momentum.x(),
                expected);
    EXPECT_NEAR(momentum.x() / expected, 1, 2e-3);
    EXPECT_LT(std::hypot(momentum.y(), momentum.z()), 1e-6 * expected);
  }
}

TEST(Charge, GivesAPlateThatIsWideForItsDistanceTheSumOverItsArea) {
  const double distance_m = 1, half_m = 2;
  double sum = 0;
  constexpr int kSide = 400;
  for (int i = 0; i < kSide; ++i) {
    for (int k = 0; k < kSide; ++k) {
      const double y = half_m * (2 * (i + 0.5) / kSide - 1),
                   z = half_m * (2 * (k + 0.5) / kSide - 1);
      const double r = std::sqrt(distance_m * distance_m + y * y + z * z);
      sum += wave_impulse(1, BurstKind::kGround, r).at_incidence(distance_m / r);
    }
  }
  sum *= std::pow(2 * half_m / kSide, 2);
  const Vec3 momentum = momentum_of(plate_scene(distance_m, half_m, 0.1, 1));
  std::printf("plate of 4 m at 1 m of 1 kg: %.5g N·s, the integral is %.5g\n", momentum.x(), sum);
  EXPECT_NEAR(momentum.x() / sum, 1, 0.03);
}

TEST(Charge, PushesASlantedPlateAlongItsNormal) {
  const double turn_rad = std::numbers::pi / 6, half_m = 0.02;
  const Vec3 momentum = momentum_of(plate_scene(2, half_m, 0.001, 1, turn_rad));
  EXPECT_NEAR(std::atan2(momentum.y(), momentum.x()), turn_rad, 0.03);
  const double expected =
      4 * half_m * half_m * wave_impulse(1, BurstKind::kGround, 2).at_incidence(std::cos(turn_rad));
  EXPECT_NEAR(momentum.norm() / expected, 1, 0.03);
}

TEST(Charge, PushesABallByTheSumOverTheHalfThatFacesIt) {
  const WaveImpulse wave{300, 100};
  double sum = 0;
  constexpr int kParts = 10000;
  for (int i = 0; i < kParts; ++i) {
    const double cosine = (i + 0.5) / kParts;
    sum += 2 * cosine * wave.at_incidence(cosine) / kParts;  // per π r²
  }
  EXPECT_NEAR(wave.on_ball(), sum, 1e-5 * sum);
  EXPECT_EQ(wave.at_incidence(1), 300);
  EXPECT_EQ(wave.at_incidence(0), 100);
}

}  // namespace
}  // namespace sunder
