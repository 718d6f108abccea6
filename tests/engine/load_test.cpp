// The load stage, with scripted physics and fracture: who is judged when, and what follows.
#include <gtest/gtest.h>

#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

/// Two boxes on top of each other, the lower one anchored or neither.
Compound two_boxes(bool anchored) {
  Compound compound;
  for (int i = 0; i < 2; ++i) {
    const Vec3 min(0, i, 0);
    compound.convexes.push_back(make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
    compound.anchored.push_back(anchored && i == 0);
  }
  compound.bonds = {{0, 1, 3, 2, 1}};
  return compound;
}

Scene scene_of(const Compound& compound) {
  Scene scene;
  Material stone;
  stone.name = "stone";
  stone.density_kg_m3 = 1000;
  stone.tensile_Pa = 1e6;
  scene.materials = {stone};
  scene.accuracy = {1.0 / 60, 1};
  scene.solids = {{"solid", compound, {}}};
  return scene;
}

/// A run whose breaker answers what the test says, and counts how often it is asked.
struct LoadRun {
  using Answer = std::function<StressResult(const Structure&, const LoadCase&)>;

  ScriptedPhysics* physics = nullptr;
  int asked = 0;
  Vec3 asked_force = Vec3::Zero(), asked_spin_R = Vec3::Zero();
  std::vector<AppliedForce> asked_loads;
  std::unique_ptr<Simulation> simulation;

  LoadRun(Scene scene, Answer answer) {
    auto owned = std::make_unique<ScriptedPhysics>(
        [](const ScriptedPhysics&, int) { return std::vector<SpeculativeContact>{}; });
    physics = owned.get();
    auto breaker = std::make_unique<ScriptedBreaker>(1.0);
    breaker->stressed = [this, answer](const Structure& structure, const LoadCase& load) {
      ++asked;
      asked_force.setZero();
      asked_spin_R = load.spin_R;
      asked_loads.assign(load.loads.begin(), load.loads.end());
      for (const AppliedForce& one : load.loads) asked_force += one.force_N;
      return answer(structure, load);
    };
    simulation =
        std::make_unique<Simulation>(std::move(scene), std::move(owned), std::move(breaker));
    simulation->next();
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) simulation->next();
  }
  /// A steady force on the top of the solid.
  void press(double force_N) {
    physics->loads = {{0, 1, Vec3(0, -force_N / 60, 0), Vec3(0.5, 2, 0.5)}};
  }
};

StressResult holds(const Structure&, const LoadCase&) {
  StressResult answer;
  answer.settled = true;
  return answer;
}

StressResult parts(const Structure& structure, const LoadCase&) {
  StressResult answer;
  answer.settled = true;
  answer.edit = ScriptedBreaker::part(structure);
  return answer;
}

TEST(LoadStage, JudgesOwnWeightOnceAndNeverAgainWhileNothingChanges) {
  LoadRun run(scene_of(two_boxes(true)), holds);
  run.frames(60);
  EXPECT_EQ(run.asked, 1);
}

TEST(LoadStage, JudgesAgainWhatIsPressedUntilThePressIsSteady) {
  LoadRun run(scene_of(two_boxes(true)), holds);
  run.frames(1);
  run.press(50000);
  run.frames(60);
  const int asked = run.asked;
  EXPECT_GT(asked, 1);
  EXPECT_LT(asked, 30);
  EXPECT_NEAR(run.asked_force.y(), -50000, 0.1 * 50000);
  run.frames(60);
  EXPECT_EQ(run.asked, asked);
  run.physics->loads.clear();
  run.frames(120);
  EXPECT_GT(run.asked, asked);  // and what is lifted off again
  EXPECT_NEAR(run.asked_force.y(), 0, 0.1 * 50000);
}

TEST(LoadStage, ABlowIsSpreadOverTheTimeOfTheAverageWhateverTheStep) {
  std::vector<double> most;
  for (const int steps : {1, 4}) {
    Scene scene = scene_of(two_boxes(true));
    scene.accuracy.dt_s = 1.0 / (60 * steps);
    double highest = 0;
    LoadRun run(scene, [&](const Structure&, const LoadCase& load) {
      for (const AppliedForce& one : load.loads) highest = std::max(highest, one.force_N.norm());
      StressResult answer;
      answer.settled = true;
      return answer;
    });
    run.physics->loads = {{0, 1, Vec3(0, -10000.0 / steps, 0), Vec3(0.5, 2, 0.5)}};
    run.frames(1);
    run.physics->loads.clear();
    run.frames(30);
    most.push_back(highest);
  }
  EXPECT_NEAR(most[0], 1e5, 0.2e5);  // 10,000 N·s over a tenth of a second
  EXPECT_NEAR(most[1], most[0], 0.15 * most[0]);
}

TEST(LoadStage, LetsFallWhatIsOverloadedAndKeepsWhatIsHeld) {
  LoadRun run(scene_of(two_boxes(true)), parts);
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->bodies.size(), 2u);
  EXPECT_TRUE(frame->bodies[0].is_static);
  EXPECT_FALSE(frame->bodies[1].is_static);
  ASSERT_EQ(frame->breaks.size(), 1u);
  EXPECT_EQ(frame->breaks[0].pieces, 2u);
  EXPECT_NEAR(frame->report.mass_kg, 2000, 1e-9);
}

TEST(LoadStage, WhatLosesItsNeighbourShowsTheFaceThatItCovered) {
  const auto indices_of = [](const Frame& frame, std::uint32_t body) {
    std::size_t sum = 0;
    for (const Instance& instance : frame.instances)
      if (instance.body == body) sum += (*frame.meshes)[instance.mesh.value]->indices.size();
    return sum;
  };
  LoadRun run(scene_of(two_boxes(true)), [](const Structure& structure, const LoadCase&) {
    StressResult answer;
    answer.settled = true;
    answer.edit.changed = structure.has(ConvexSlot(1));
    if (!answer.edit.changed) return answer;
    answer.edit.removed = {ConvexSlot(1)};
    answer.edit.loose.pieces = {{{structure.convex(ConvexSlot(1))}, {0}, {}, {}}};
    return answer;
  });
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->bodies.size(), 2u);
  EXPECT_EQ(indices_of(*frame, 0), 6u * 6) << "with its upper face";
}

TEST(LoadStage, AJointLoadsTheConvexThatIsNearestToItsAnchor) {
  LoadRun run(scene_of(two_boxes(true)), holds);
  const Vec3 pull(0, -5e4, 0), turn(3e4, 0, 0);
  for (const double y : {1.5, 2.4}) {  // inside and outside
    run.physics->pulls = {{0, pull / 60, Vec3(0.25, y, 0.5), turn / 60}};
    run.frames(120);
    ASSERT_EQ(run.asked_loads.size(), 1u);
    const AppliedForce& load = run.asked_loads[0];
    EXPECT_EQ(load.convex, ConvexSlot(1));
    EXPECT_LT((load.force_N - pull).norm(), 0.1 * pull.norm());
    const Vec3 about = (Vec3(0.25, y, 0.5) - load.point_R).cross(pull) + turn;
    EXPECT_LT((load.torque_Nm - about).norm(), 0.1 * about.norm());
  }
  run.physics->pulls[0].point_W = Vec3(0.5, -0.1, 0.5);
  run.frames(120);
  EXPECT_EQ(run.asked_loads[0].convex, ConvexSlot(0));
  EXPECT_LT((run.asked_loads[0].force_N - pull).norm(), 0.1 * pull.norm());
}

TEST(LoadStage, AWrenchWithoutAForceLoadsToo) {
  LoadRun run(scene_of(two_boxes(true)), holds);
  run.physics->pulls = {{0, Vec3::Zero(), Vec3(0.5, 1.5, 0.5), Vec3(0, 5e4 / 60, 0)}};
  run.frames(120);
  ASSERT_EQ(run.asked_loads.size(), 1u);
  EXPECT_NEAR(run.asked_loads[0].torque_Nm.y(), 5e4, 0.1 * 5e4);
}

// ρ ω² r² is the limit of 1 MPa at 667 s⁻², and a thirtieth of that is at 4.5 rad/s.
TEST(LoadStage, JudgesSpinWhenItCanMatterAndAgainWhenItHasChanged) {
  Scene scene = scene_of(two_boxes(false));
  scene.gravity_W.setZero();
  LoadRun run(scene, holds);
  const auto spin = [&](double spin_rad_s) {
    run.physics->bodies[1].state.angular_velocity_W = Vec3(spin_rad_s, 0, 0);
    run.frames(10);
    return run.asked;
  };
  EXPECT_EQ(spin(4), 0);
  EXPECT_EQ(spin(20), 1);
  EXPECT_EQ(run.asked_spin_R, Vec3(20, 0, 0));
  EXPECT_EQ(spin(20.9), 1);
  EXPECT_EQ(spin(-20.9), 1) << "the stress is equal for the opposite spin";
  EXPECT_EQ(spin(21.1), 2);
  EXPECT_EQ(spin(-21.1), 2);
}

TEST(LoadStage, OfSmallFragmentsOnlySpinIsLookedAt) {
  Compound compound = two_boxes(true);
  compound.convexes.push_back(
      make_convex(make_box(Vec3(0, 2, 0), Vec3(1, 3, 1)), MaterialIndex(0)));
  compound.anchored.push_back(0);
  compound.bonds.push_back({1, 2, 3, 2, 1});
  LoadRun run(scene_of(compound), [](const Structure& structure, const LoadCase&) {
    StressResult answer;
    answer.settled = true;
    answer.edit.changed = structure.size() == 3;
    if (!answer.edit.changed) return answer;
    const auto& box = [&](std::uint32_t slot) { return structure.convex(ConvexSlot(slot)); };
    answer.edit.removed = {ConvexSlot(1), ConvexSlot(2)};
    answer.edit.loose.pieces = {{{box(1), box(2)}, {0, 0}, {{0, 1, 3, 2, 1}}, {}}};
    return answer;
  });
  run.frames(2);
  ASSERT_EQ(run.physics->bodies.size(), 3u);  // with the ground
  EXPECT_TRUE(run.physics->bodies[1].desc.reports_load);
  EXPECT_FALSE(run.physics->bodies[2].desc.reports_load);
  const int asked = run.asked;
  run.physics->bodies[2].state.angular_velocity_W = Vec3(20, 0, 0);
  run.frames(10);
  EXPECT_EQ(run.asked, asked + 1);
}

TEST(LoadStage, DoesNotAskAboutSingleConvexesNorAboutWhatNoLoadBreaks) {
  Compound box = two_boxes(false);
  box.convexes.resize(1), box.anchored.resize(1), box.bonds.clear();
  LoadRun moving(scene_of(box), parts);
  moving.press(1e6);
  moving.frames(30);
  EXPECT_EQ(moving.asked, 0);
  Scene scene = scene_of(two_boxes(true));
  scene.materials[0].tensile_Pa = 0;
  LoadRun unbreakable(scene, parts);
  unbreakable.frames(30);
  EXPECT_EQ(unbreakable.asked, 0);
}

TEST(LoadStage, PutsOffWhatExceedsTheBudgetAndLosesNothing) {
  Scene scene = scene_of(two_boxes(true));
  scene.solids.push_back(scene.solids[0]);
  scene.limits.load_work_a_frame = 10;
  std::vector<std::uint64_t> allowed;
  LoadRun run(scene, [&](const Structure& structure, const LoadCase& load) {
    allowed.push_back(load.most_work);
    StressResult answer = parts(structure, load);
    answer.work = load.most_work;
    return answer;
  });
  const FramePtr first = run.simulation->next();
  EXPECT_EQ(first->breaks.size(), 1u);
  EXPECT_EQ(first->report.carried_over, 1u);
  const FramePtr second = run.simulation->next();
  EXPECT_EQ(second->breaks.size(), 1u);
  EXPECT_EQ(second->report.carried_over, 0u);
  EXPECT_EQ(allowed, (std::vector<std::uint64_t>{10, 10}));
}

TEST(LoadStage, AFrameMaySpendWhatTheOneBeforeSaved) {
  Scene scene = scene_of(two_boxes(true));
  scene.limits.load_work_a_frame = 10;
  std::vector<std::uint64_t> allowed;
  LoadRun run(scene, [&](const Structure&, const LoadCase& load) {
    allowed.push_back(load.most_work);
    StressResult answer;
    answer.settled = true;
    answer.work = load.most_work;
    return answer;
  });
  run.frames(5);
  run.press(1e6);
  run.frames(1);
  EXPECT_EQ(allowed, (std::vector<std::uint64_t>{10, 20}))
      << "the unused budget of one frame, and no more";
}

TEST(LoadStage, GivesTheMemoryBack) {
  struct Marked final : StressCache {};
  const auto memory = std::make_shared<const Marked>();
  StressCachePtr seen;
  LoadRun run(scene_of(two_boxes(true)), [&](const Structure&, const LoadCase& load) {
    seen = load.memory;
    StressResult answer;
    answer.settled = seen != nullptr;
    answer.memory = memory;
    return answer;
  });
  run.frames(3);
  EXPECT_EQ(seen, memory);
  EXPECT_EQ(run.asked, 2);
}

}  // namespace
}  // namespace sunder
