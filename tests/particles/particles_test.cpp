// Tests of debris and dust together, behind the Particles interface.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "solver/particles/crumble.h"
#include "solver/particles/debris_and_dust.h"
#include "tests/particles/particles_fixtures.h"

namespace sunder::solver::particles_test {
namespace {

constexpr double kDt = 1.0 / 60;

DebrisAndDustOptions small_options() {
  DebrisAndDustOptions options;
  options.max_air_cells = Eigen::Vector3i(32, 16, 32);
  return options;
}

DebrisEmission crumbling_of(double particles_per_m2, double debris_ratio) {
  DebrisEmission crumbling;
  crumbling.particles_per_m2 = particles_per_m2;
  crumbling.debris_ratio = debris_ratio;
  return crumbling;
}

template <class T>
std::uint64_t hash_of(std::span<const T> values) {
  std::uint64_t hash = values.size();
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size_bytes(); ++i) hash = combine(hash, bytes[i]);
  return hash;
}

std::uint64_t hash_of(const Particles& particles) {
  const DebrisView debris = particles.debris();
  const DustView dust = particles.dust();
  std::uint64_t hash = 0;
  for (const std::uint64_t part :
       {hash_of(debris.position_W), hash_of(debris.rotation_WD), hash_of(debris.radius_m),
        hash_of(debris.variant), hash_of(dust.position_W), hash_of(dust.rotation_WD),
        hash_of(dust.radius_m), hash_of(dust.opacity)}) {
    hash = combine(hash, part);
  }
  return hash;
}

/// Runs chips and dust among boxes, some of which move; chips fall asleep, are woken, and some are
/// rejected at the limit. Returns a hash of every step.
std::uint64_t run_and_hash(int thread_count) {
  set_threads(thread_count);
  DebrisAndDustOptions options = small_options();
  options.limits = {2500, 20000};
  auto particles = make_debris_and_dust(options);
  TestObstacles obstacles;
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    const Vec3 at = 2 * random.direction() + Vec3(0, 2, 0);
    const Vec3 half(random.uniform(0.05, 0.4), random.uniform(0.05, 0.4), 0.2);
    const Quat rotation = Quat(1, random.uniform(), random.uniform(), 0).normalized();
    const std::size_t body = obstacles.add_box(at, half, rotation);
    if (i % 3 == 0) obstacles.set_velocity(body, 2 * random.direction());
  }
  std::uint64_t hash = 0;
  std::uint32_t asleep = 0;
  for (int step = 0; step < 110; ++step) {
    if (step % 10 == 0 && step < 60) {
      const TestFace face(Vec3(0.1 * step - 2, 1.5, 0));
      const ExposedPolygon emission = face.emission(crumbling_of(1200, 0.5));
      particles->emit(std::span(&emission, 1));
    }
    obstacles.advance(kDt);
    particles->advance(kDt, obstacles.view());
    hash = combine(hash, hash_of(*particles));
    const ParticleCounts counts = particles->report().debris;
    asleep = std::max(asleep, counts.alive - counts.awake);
  }
  const ParticleReport report = particles->report();
  EXPECT_GT(asleep, 500u);
  EXPECT_GT(report.debris.ignored, 50u);
  EXPECT_GT(report.dust.alive, 2500u);
  return hash;
}

TEST(Particles, AreTheSameBitsForOneTwoFourAndSevenThreads) {
  const int before = threads();
  const std::uint64_t one = run_and_hash(1);
  for (const int count : {2, 4, 7}) EXPECT_EQ(run_and_hash(count), one) << count;
  set_threads(before);
}

TEST(Particles, ComeFromAFaceByItsDensityAndRatio) {
  auto particles = make_debris_and_dust(small_options());
  const TestFace face(Vec3(0, 3, 0), 2);
  const ExposedPolygon emission = face.emission(crumbling_of(1000, 0.25));
  particles->emit(std::span(&emission, 1));
  const ParticleReport report = particles->report();
  EXPECT_EQ(report.debris.alive + report.dust.alive, 4000u);
  EXPECT_NEAR(report.debris.alive, 1000, 100);
  Vec3f mean = Vec3f::Zero();
  for (const Vec3f& at : particles->dust().position_W) {
    ASSERT_NEAR(at.y(), 3, 1e-6);
    ASSERT_LE(std::max(std::abs(at.x()), std::abs(at.z())), 1);
    mean += at / float(report.dust.alive);
  }
  EXPECT_NEAR(mean.x(), 0, 0.05);
  EXPECT_NEAR(mean.z(), 0, 0.05);
}

// The dust of a face accelerates the air by its mass.
TEST(Particles, TheDustOfAFaceIsAsHeavyWhateverTheRatioOfDebris) {
  const auto wind_m_s = [](double debris_ratio) {
    Debris debris(20000, Vec3::Zero());
    Dust dust(20000, Vec3::Zero(), Vec3i(32, 16, 32));
    Random random(5);
    const TestFace face(Vec3(0, 3, 0), 2);
    ExposedPolygon emission = face.emission(crumbling_of(4000, debris_ratio));
    emission.crumbling.dust_kg_m2 = 0.1;
    emission.opening_speed_m_s = 10;
    crumble(emission, {}, random, debris, dust);
    dust.advance(kDt, TestObstacles().view());
    float sum_m_s = 0;  // below the face, on a grid of 7 by 7 points
    for (int i = 0; i < 49; ++i) {
      const Vec3f below(0.2f * float(i % 7 - 3), 2.9f, 0.2f * float(i / 7 - 3));
      sum_m_s -= dust.air()->velocity(below).y();
    }
    return sum_m_s / 49;
  };
  const float of_dust_alone = wind_m_s(0);
  EXPECT_GT(of_dust_alone, 0.01f);
  for (const double ratio : {0.25, 0.75})
    EXPECT_NEAR(wind_m_s(ratio), of_dust_alone, 0.2f * of_dust_alone) << ratio;
}

TEST(Particles, ComeFromEveryFaceEvenAtTheLimit) {
  DebrisAndDustOptions options = small_options();
  options.limits = {500, 500};
  auto particles = make_debris_and_dust(options);
  const TestFace left(Vec3(-10, 3, 0)), right(Vec3(10, 3, 0));
  const ExposedPolygon faces[] = {left.emission(crumbling_of(2000, 0.5)),
                                  right.emission(crumbling_of(2000, 0.5))};
  particles->emit(faces);
  const ParticleReport report = particles->report();
  EXPECT_LE(report.debris.alive, 500u);
  EXPECT_GT(report.debris.alive, 400u);
  EXPECT_EQ(
      report.debris.emitted + report.debris.ignored + report.dust.emitted + report.dust.ignored,
      4000u);
  int on_right = 0;
  for (const Vec3f& at : particles->dust().position_W) on_right += at.x() > 0;
  EXPECT_NEAR(on_right, report.dust.alive / 2.0, 50);
}

TEST(Particles, OfManySmallFacesAreAsManyAsOfOneLargeFace) {
  auto particles = make_debris_and_dust(small_options());
  const TestFace face(Vec3(0, 3, 0), 0.01);
  const std::vector<ExposedPolygon> faces(10000, face.emission(crumbling_of(1000, 0.5)));
  particles->emit(faces);
  const ParticleReport report = particles->report();
  EXPECT_NEAR(report.debris.emitted + report.dust.emitted, 1000, 100);
}

TEST(Particles, AreFewAndSlowAtAClosedCrackAndManyAndFastAtOneOpenedByAnImpact) {
  const TestFace face(Vec3(0, 3, 0));
  std::uint32_t alive[3];
  double mean_m[3];
  int i = 0;
  for (const double opening_speed_m_s : {0.0, 2.0, 20.0}) {
    DebrisAndDustOptions options = small_options();
    options.gravity_W.setZero();
    auto particles = make_debris_and_dust(options);
    ExposedPolygon emission = face.emission(crumbling_of(4000, 0.5));
    emission.opening_speed_m_s = opening_speed_m_s;
    particles->emit(std::span(&emission, 1));
    alive[i] = particles->report().debris.alive + particles->report().dust.alive;
    particles->advance(kDt, TestObstacles().view());
    double sum_m = 0;
    for (const Vec3f& at : particles->debris().position_W) sum_m += 3 - double{at.y()};
    mean_m[i++] = sum_m / particles->report().debris.alive;
  }
  EXPECT_GT(alive[0], 0u);
  EXPECT_LT(alive[0] * 5, alive[1]);
  EXPECT_LT(alive[1], alive[2]);
  EXPECT_EQ(alive[2], 4000u) << "at most the material's number";
  EXPECT_LT(mean_m[0], mean_m[1]);
  EXPECT_LT(1.5 * mean_m[1], mean_m[2]);
}

TEST(Particles, DebrisSizesFollowAPowerLaw) {
  auto particles = make_debris_and_dust(small_options());
  DebrisEmission crumbling = crumbling_of(40000, 1);
  crumbling.debris_smallest_m = 0.01;
  crumbling.debris_largest_m = 0.1;
  const TestFace face(Vec3(0, 3, 0));
  const ExposedPolygon emission = face.emission(crumbling);
  particles->emit(std::span(&emission, 1));
  int over_2cm = 0, over_4cm = 0;
  for (const float radius : particles->debris().radius_m) {
    ASSERT_GE(radius, 0.01f - 1e-7f);
    ASSERT_LE(radius, 0.1f + 1e-7f);
    over_2cm += radius > 0.02f;
    over_4cm += radius > 0.04f;
  }
  // N(> r) = ((s/r)² − (s/l)²) / (1 − (s/l)²).
  EXPECT_NEAR(over_2cm / 40000.0, (0.25 - 0.01) / 0.99, 0.01);
  EXPECT_NEAR(over_4cm / 40000.0, (0.0625 - 0.01) / 0.99, 0.005);
}

TEST(Particles, InheritTheMotionOfTheirSolid) {
  DebrisAndDustOptions options = small_options();
  options.gravity_W.setZero();
  auto particles = make_debris_and_dust(options);
  const TestFace face(Vec3(10, 3, 0), 0.1);
  ExposedPolygon emission = face.emission(crumbling_of(10000, 1));
  emission.motion = {Vec3(0, 3, 0), Vec3(0, 5, 0), Vec3(0, 0, 2)};
  particles->emit(std::span(&emission, 1));
  particles->advance(kDt, TestObstacles().view());
  Vec3f mean = Vec3f::Zero();
  for (const Vec3f& at : particles->debris().position_W) mean += at;
  mean /= float(particles->report().debris.alive);
  EXPECT_NEAR((double{mean.y()} - 3) / kDt, 5 + 2 * 10, 2.5);
}

TEST(Particles, AChipIsOneParticleWithItsVelocity) {
  auto particles = make_debris_and_dust(small_options());
  DebrisPiece chip;
  chip.center_W = Vec3(1, 5, 2);
  chip.radius_m = 0.03;
  chip.velocity_W = Vec3(0, 0, 6);
  particles->emit(std::span(&chip, 1));
  EXPECT_EQ(particles->report().debris.alive, 1u);
  EXPECT_EQ(particles->debris().radius_m[0], 0.03f);
  particles->advance(kDt, TestObstacles().view());
  EXPECT_NEAR(particles->debris().position_W[0].z(), 2 + 6 * kDt, 1e-5);
}

TEST(Particles, WithoutDustHaveNoAir) {
  auto particles = make_debris_and_dust(small_options());
  const TestFace face(Vec3(0, 3, 0));
  ExposedPolygon emission = face.emission(crumbling_of(1000, 1));
  particles->emit(std::span(&emission, 1));
  particles->advance(kDt, TestObstacles().view());
  EXPECT_EQ(particles->report().air_cells, 0u);
  emission.crumbling.debris_ratio = 0;
  particles->emit(std::span(&emission, 1));
  particles->advance(kDt, TestObstacles().view());
  EXPECT_GT(particles->report().air_cells, 0u);
}

/// Returns the air cells after each emission of that many more puffs, from one face above another.
std::vector<std::uint32_t> cells_after(double apart_m, std::span<const double> more) {
  auto particles = make_debris_and_dust(small_options());
  const TestFace low(Vec3(0, 2, 0), 10), high(Vec3(0, 2 + apart_m, 0), 10);
  std::vector<std::uint32_t> cells;
  for (const double puffs : more) {
    for (const TestFace* face : {&low, &high}) {
      const ExposedPolygon emission = face->emission(crumbling_of(puffs / 200, 0));
      particles->emit(std::span(&emission, 1));
    }
    particles->advance(kDt, TestObstacles().view());
    cells.push_back(particles->report().air_cells);
  }
  return cells;
}

TEST(Particles, HaveAirCellsByTheirNumber) {
  const auto cells = cells_after(8, std::vector<double>{100, 700, 3000});
  EXPECT_LE(cells[0], 32u * 16 * 32 / 8);
  EXPECT_GT(cells[1], cells[0]);
  EXPECT_LT(cells[1], cells[2]);
  EXPECT_EQ(cells[2], 32u * 16 * 32);
}

TEST(Particles, HaveAirCellsUpToTheHeightOfTheirCloud) {
  EXPECT_EQ(cells_after(1, std::vector<double>{4000})[0], 32u * 8 * 32);
}

}  // namespace
}  // namespace sunder::solver::particles_test
