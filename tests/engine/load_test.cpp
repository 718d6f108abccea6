// Tests of the load stage, with scripted physics and breaker: when a solid's stress is evaluated,
// and the breaks that result.
#include <gtest/gtest.h>

#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

/// Returns two boxes on top of each other, with the lower one anchored if `anchored`.
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

/// Simulation whose breaker returns the test's answers, and records the last load evaluated.
struct LoadRun {
  using Answer = std::function<StressResult(const Structure&, const LoadCase&)>;

  ScriptedPhysics* physics = nullptr;
  int evaluations = 0;
  Vec3 evaluated_force = Vec3::Zero(), evaluated_spin_R = Vec3::Zero();
  std::vector<AppliedForce> evaluated_loads;
  std::unique_ptr<Simulation> simulation;

  LoadRun(Scene scene, Answer answer) {
    auto owned = std::make_unique<ScriptedPhysics>(
        [](const ScriptedPhysics&, int) { return std::vector<SpeculativeContact>{}; });
    physics = owned.get();
    auto breaker = std::make_unique<ScriptedBreaker>(1.0);
    breaker->stressed = [this, answer](const Structure& structure, const LoadCase& load) {
      ++evaluations;
      evaluated_force.setZero();
      evaluated_spin_R = load.spin_R;
      evaluated_loads.assign(load.loads.begin(), load.loads.end());
      for (const AppliedForce& one : load.loads) evaluated_force += one.force_N;
      return answer(structure, load);
    };
    simulation =
        std::make_unique<Simulation>(std::move(scene), std::move(owned), std::move(breaker));
    simulation->next();
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) simulation->next();
  }
  /// Applies a steady downward force to the top of the solid.
  void apply_top_force(double force_N) {
    physics->loads = {{0, 1, Vec3(0, -force_N / 60, 0), Vec3(0.5, 2, 0.5)}};
  }
};

StressResult keep_whole(const Structure&, const LoadCase&) {
  StressResult answer;
  answer.settled = true;
  return answer;
}

StressResult split_in_parts(const Structure& structure, const LoadCase&) {
  StressResult answer;
  answer.settled = true;
  answer.edit = ScriptedBreaker::part(structure);
  return answer;
}

TEST(LoadStage, EvaluatesSelfWeightOnceWhileNothingChanges) {
  LoadRun run(scene_of(two_boxes(true)), keep_whole);
  run.frames(60);
  EXPECT_EQ(run.evaluations, 1);
}

TEST(LoadStage, EvaluatesASolidAgainUntilItsLoadIsSteady) {
  LoadRun run(scene_of(two_boxes(true)), keep_whole);
  run.frames(1);
  run.apply_top_force(50000);
  run.frames(60);
  const int evaluations = run.evaluations;
  EXPECT_GT(evaluations, 1);
  EXPECT_LT(evaluations, 30);
  EXPECT_NEAR(run.evaluated_force.y(), -50000, 0.1 * 50000);
  run.frames(60);
  EXPECT_EQ(run.evaluations, evaluations);
  run.physics->loads.clear();
  run.frames(120);
  EXPECT_GT(run.evaluations, evaluations);  // the load is removed
  EXPECT_NEAR(run.evaluated_force.y(), 0, 0.1 * 50000);
}

TEST(LoadStage, AnImpulseIsSpreadOverTheAveragingTimeWhateverTheStep) {
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

TEST(LoadStage, OverloadedPartsFallAndAnchoredPartsStay) {
  LoadRun run(scene_of(two_boxes(true)), split_in_parts);
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->bodies.size(), 2u);
  EXPECT_TRUE(frame->bodies[0].is_static);
  EXPECT_FALSE(frame->bodies[1].is_static);
  ASSERT_EQ(frame->breaks.size(), 1u);
  EXPECT_EQ(frame->breaks[0].pieces, 2u);
  EXPECT_NEAR(frame->report.mass_kg, 2000, 1e-9);
}

TEST(LoadStage, RemovingANeighbourShowsTheFaceThatItCovered) {
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
  LoadRun run(scene_of(two_boxes(true)), keep_whole);
  const Vec3 pull(0, -5e4, 0);
  for (const double y : {1.5, 2.4}) {  // inside and outside
    run.physics->pulls = {{0, pull / 60, Vec3(0.25, y, 0.5), Vec3::Zero()}};
    run.frames(120);
    ASSERT_EQ(run.evaluated_loads.size(), 1u);
    const AppliedForce& load = run.evaluated_loads[0];
    EXPECT_EQ(load.convex, ConvexSlot(1));
    EXPECT_LT((load.force_N - pull).norm(), 0.1 * pull.norm());
    const Vec3 about = (Vec3(0.25, y, 0.5) - load.point_R).cross(pull);
    EXPECT_LT((load.torque_Nm - about).norm(), 0.1 * about.norm());
  }
  run.physics->pulls[0].point_W = Vec3(0.5, -0.1, 0.5);
  run.frames(120);
  EXPECT_EQ(run.evaluated_loads[0].convex, ConvexSlot(0));
  EXPECT_LT((run.evaluated_loads[0].force_N - pull).norm(), 0.1 * pull.norm());
}

TEST(LoadStage, ATorqueActsOnTheConvexesAroundTheAnchorAsOnOneBlock) {
  LoadRun run(scene_of(two_boxes(true)), keep_whole);
  const Vec3 pull(2e4, 0, 0), turn(0, 5e4, 1e4);
  run.physics->pulls = {{0, pull / 60, Vec3(0.5, 1.5, 0.5), turn / 60}};
  run.frames(120);
  ASSERT_EQ(run.evaluated_loads.size(), 2u);  // both are within half the thickness of 1 m
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (const AppliedForce& load : run.evaluated_loads) {
    force += load.force_N;
    moment += load.torque_Nm + (load.point_R - Vec3(0.5, 1.5, 0.5)).cross(load.force_N);
  }
  EXPECT_LT((force - pull).norm(), 0.1 * pull.norm());
  EXPECT_LT((moment - turn).norm(), 0.1 * turn.norm());
}

// The stress ρ ω² r² is the limit of 1 MPa at ω² = 667 s⁻², and a thirtieth of it at 4.5 rad/s.
TEST(LoadStage, EvaluatesSpinOnceItCanMatterAndAgainWhenItChanges) {
  Scene scene = scene_of(two_boxes(false));
  scene.gravity_W.setZero();
  LoadRun run(scene, keep_whole);
  const auto spin = [&](double spin_rad_s) {
    run.physics->bodies[1].state.angular_velocity_W = Vec3(spin_rad_s, 0, 0);
    run.frames(10);
    return run.evaluations;
  };
  EXPECT_EQ(spin(4), 0);
  EXPECT_EQ(spin(20), 1);
  EXPECT_EQ(run.evaluated_spin_R, Vec3(20, 0, 0));
  EXPECT_EQ(spin(20.9), 1);
  EXPECT_EQ(spin(-20.9), 1) << "the stress is equal for the opposite spin";
  EXPECT_EQ(spin(21.1), 2);
  EXPECT_EQ(spin(-21.1), 2);
}

TEST(LoadStage, OnlySpinIsEvaluatedForSmallFragments) {
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
  const int evaluations = run.evaluations;
  run.physics->bodies[2].state.angular_velocity_W = Vec3(20, 0, 0);
  run.frames(10);
  EXPECT_EQ(run.evaluations, evaluations + 1);
}

TEST(LoadStage, DoesNotEvaluateSingleConvexesNorUnbreakableMaterials) {
  Compound box = two_boxes(false);
  box.convexes.resize(1), box.anchored.resize(1), box.bonds.clear();
  LoadRun moving(scene_of(box), split_in_parts);
  moving.apply_top_force(1e6);
  moving.frames(30);
  EXPECT_EQ(moving.evaluations, 0);
  Scene scene = scene_of(two_boxes(true));
  scene.materials[0].tensile_Pa = 0;
  LoadRun unbreakable(scene, split_in_parts);
  unbreakable.frames(30);
  EXPECT_EQ(unbreakable.evaluations, 0);
}

TEST(LoadStage, DefersEvaluationsOverTheBudgetAndDropsNone) {
  Scene scene = scene_of(two_boxes(true));
  scene.solids.push_back(scene.solids[0]);
  scene.limits.load_work_a_frame = 10;
  std::vector<std::uint64_t> allowed;
  LoadRun run(scene, [&](const Structure& structure, const LoadCase& load) {
    allowed.push_back(load.most_work);
    StressResult answer = split_in_parts(structure, load);
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

TEST(LoadStage, AFrameMayUseTheBudgetThatTheFrameBeforeLeft) {
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
  run.apply_top_force(1e6);
  run.frames(1);
  EXPECT_EQ(allowed, (std::vector<std::uint64_t>{10, 20}))
      << "the unused budget of one frame, and no more";
}

TEST(LoadStage, AStepOfHalfAFrameHasHalfOfItsBudget) {
  Scene scene = scene_of(two_boxes(true));
  scene.limits.load_work_a_frame = 10;
  std::vector<std::uint64_t> allowed;
  LoadRun run(scene, [&](const Structure&, const LoadCase& load) {
    allowed.push_back(load.most_work);
    StressResult answer;
    answer.settled = true;
    return answer;
  });
  run.simulation->world().step(1.0 / 120);
  EXPECT_EQ(allowed, (std::vector<std::uint64_t>{5}));
}

TEST(LoadStage, PassesTheStressCacheBack) {
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
  EXPECT_EQ(run.evaluations, 2);
}

}  // namespace
}  // namespace sunder
