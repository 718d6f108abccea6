// Tests of yielding steel in random scenes: conservation, equal bits for any number of threads, and
// no joint at a removed body.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/io/recording/recording.h"
#include "engine/io/state_hash.h"
#include "tests/motion/bending.h"

namespace sunder::tests {
namespace {

TEST(Bending, ThrownBarsKeepMassAndMomentaAndGainNoEnergy) {
  std::size_t hinges = 0, breaks = 0, replaced = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    BendingRun run(thrown_bars(seed));
    const Motions first = run.spy->sum();
    double least_J = run.energy_J();
    while (run.frame->time_s < 1.5) {
      ASSERT_NO_FATAL_FAILURE(run.step());
      // A section that yields while it spins counts slightly more plastic work than it takes.
      EXPECT_LE(run.energy_J(), least_J + 3e-3 * first.kinetic_J) << run.frame->time_s;
      least_J = std::min(least_J, run.energy_J());
    }
    const Motions last = run.spy->sum();
    EXPECT_NEAR(last.mass_kg, first.mass_kg, 1e-12 * first.mass_kg);
    EXPECT_NEAR(run.frame->report.mass_kg, first.mass_kg, 1e-12 * first.mass_kg);
    const double most_Ns = std::sqrt(2 * first.kinetic_J * first.mass_kg);
    EXPECT_LT((last.momentum - first.momentum).norm(), 2e-6 * most_Ns);
    // Bodies turn on until an impact within the step, so spin is exact only for each replacement.
    for (const SpyPhysics::Replacement& one : run.spy->replacements) {
      EXPECT_LT((one.after.momentum - one.before.momentum).norm(), 1e-11 * most_Ns);
      EXPECT_LT((one.after.spin - one.before.spin).norm(), 1e-10 * most_Ns);
    }
    EXPECT_EQ(run.frame->report.frozen, 0u);
    hinges += run.joints->hinges;
    breaks += run.breaks;
    replaced += run.spy->replacements.size();
  }
  std::printf("bends: %zu hinges, %zu breaks, %zu replaced\n", hinges, breaks, replaced);
  EXPECT_GT(hinges, 300u);
  EXPECT_GT(breaks, 50u);
}

TEST(Bending, FramesUnderImpactKeepMass) {
  std::size_t hinges = 0, breaks = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    BendingRun run(frames_and_bars(seed));
    const double mass_kg = run.frame->report.mass_kg;
    while (run.frame->time_s < 2.5) {
      ASSERT_NO_FATAL_FAILURE(run.step());
      EXPECT_NEAR(run.frame->report.mass_kg, mass_kg, 1e-12 * mass_kg);
    }
    hinges += run.joints->hinges;
    breaks += run.breaks;
  }
  std::printf("bends: %zu hinges, %zu breaks\n", hinges, breaks);
  EXPECT_GT(hinges, 300u);
}

TEST(Bending, TheBitsAreEqualForAnyNumberOfThreads) {
  for (const auto& scene_of : {thrown_bars, frames_and_bars}) {
    for (const std::uint64_t seed : {3, 12}) {
      std::vector<std::uint64_t> hashes;
      std::size_t hinges = 0;
      for (const int count : {1, 2, 7}) {
        set_threads(count);
        BendingRun run(scene_of(seed));
        std::uint64_t hash = 0;
        while (run.frame->time_s < 1) {
          ASSERT_NO_FATAL_FAILURE(run.step());
          hash = combine(hash, hash_state(*run.frame));
        }
        hashes.push_back(hash);
        hinges += run.joints->hinges;
      }
      EXPECT_EQ(hashes, std::vector<std::uint64_t>(3, hashes[0])) << seed;
      EXPECT_GT(hinges, 6u);
    }
  }
  set_threads(0);
}

/// The scenes remove anchors, remove the frame, or age fragments while steel bends.
TEST(Bending, NoJointStaysAtARemovedBody) {
  std::uint32_t lost = 0, aged = 0;
  std::size_t hinges = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = frames_and_bars(seed);
    scene.removals.push_back({0.8, {}, {Vec3(-1, -1, -1), Vec3(0.5, 0.3, 1)}});
    if (seed % 3 == 0) scene.removals.push_back({1.2, {}, {Vec3(0.5, -1, -1), Vec3(9, 0.3, 1)}});
    if (seed % 3 == 1) scene.removals.push_back({1.5, {0}, {}});
    if (seed % 3 == 2) scene.limits.ageing = 4;
    BendingRun run(scene);
    const double mass_kg = run.frame->report.mass_kg;
    while (run.frame->time_s < 2.5) {
      ASSERT_NO_FATAL_FAILURE(run.step());
      EXPECT_NEAR(run.frame->report.mass_kg, mass_kg, 1e-12 * mass_kg);
      lost += run.frame->report.joints_lost;
      aged += run.frame->report.aged;
    }
    hinges += run.joints->hinges;
  }
  std::printf("gone: %zu hinges, %u lost, %u aged\n", hinges, lost, aged);
  EXPECT_GT(lost, 10u);
}

TEST(Bending, ASaggingBeamComesToRestAndStaysAtRest) {
  for (const double utilisation : {1.05, 1.3, 2.0}) {
    SCOPED_TRACE(utilisation);
    BendingRun run(sagging_beam(utilisation));
    while (run.frame->time_s < 4) ASSERT_NO_FATAL_FAILURE(run.step());
    EXPECT_GT(run.frame->report.plastic_J, 0);
    EXPECT_EQ(run.frame->report.counts.awake, 0u);
    const std::vector<std::uint64_t> states = run.states();
    const double plastic_J = run.frame->report.plastic_J;
    while (run.frame->time_s < 6) ASSERT_NO_FATAL_FAILURE(run.step());
    EXPECT_EQ(run.states(), states);
    EXPECT_EQ(run.frame->report.plastic_J, plastic_J);
  }
}

/// Returns the positions of all drawn vertices, in W.
std::vector<Vec3> drawn(const Frame& frame) {
  std::vector<Vec3> points;
  for (const Instance& instance : frame.instances) {
    const FrameBody& body = frame.bodies[instance.body];
    const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
    for (const Mesh::Vertex& vertex : mesh.vertices) {
      const Vec3 at_T = mesh.origin_T + vertex.position.cast<double>();
      points.push_back(body.X_WB * Vec3(mesh.X_RT * at_T - body.com_R));
    }
  }
  return points;
}

/// Returns the largest distance of a point of `from` to the nearest point of `to`, in m.
double farthest(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double farthest = 0;
  for (const Vec3& point : from) {
    double nearest = 1e9;
    for (const Vec3& other : to) nearest = std::min(nearest, (point - other).squaredNorm());
    farthest = std::max(farthest, nearest);
  }
  return std::sqrt(farthest);
}

TEST(Bending, BodiesAreDrawnInPlaceWhenTheyAreRejoined) {
  BendingRun run(sagging_beam(2.0));
  int rejoined = 0;
  while (run.frame->time_s < 2) {
    const FramePtr before = run.frame;
    const std::size_t joined = run.joints->joined();
    ASSERT_NO_FATAL_FAILURE(run.step());
    if (run.joints->joined() >= joined) continue;
    ++rejoined;
    const std::vector<Vec3> then = drawn(*before), now = drawn(*run.frame);
    EXPECT_LT(farthest(then, now), 2e-3) << run.frame->time_s;
    EXPECT_LT(farthest(now, then), 2e-3) << run.frame->time_s;
  }
  EXPECT_GE(rejoined, 3);
}

TEST(Bending, BentMeshesAreRecordedExactly) {
  const auto path = std::filesystem::temp_directory_path() / "bends_test.take";
  std::vector<FramePtr> frames;
  {
    BendingRun run(sagging_beam(2.0));
    RecordingWriter writer(path);
    bool bent = false;
    for (; run.frame->time_s < 2; run.step()) {
      writer.take(run.frame);
      frames.push_back(run.frame);
      for (const Instance& instance : run.frame->instances)
        bent = bent || (*run.frame->meshes)[instance.mesh.value]->X_RT.rotation.w() < 1 - 1e-4;
    }
    writer.finish();
    EXPECT_TRUE(bent);
  }
  RecordingReader reader(path);
  for (const FramePtr& frame : frames) {
    const FramePtr read = reader.next();
    ASSERT_TRUE(read);
    EXPECT_EQ(read->report.plastic_J, frame->report.plastic_J);
    ASSERT_EQ(read->instances.size(), frame->instances.size());
    for (std::size_t i = 0; i < read->instances.size(); ++i) {
      const Pose& now = (*read->meshes)[read->instances[i].mesh.value]->X_RT;
      const Pose& then = (*frame->meshes)[frame->instances[i].mesh.value]->X_RT;
      EXPECT_EQ(now.position, then.position);
      EXPECT_EQ(now.rotation.coeffs(), then.rotation.coeffs());
    }
  }
  EXPECT_EQ(reader.next(), nullptr);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace sunder::tests
