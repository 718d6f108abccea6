// Tests of scripted actions (blasts, removals, drives, joints, wrecking balls) and of ageing.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

std::vector<SpeculativeContact> none(const ScriptedPhysics&, int) { return {}; }

Scene empty_scene() {
  Scene scene;
  Material stone;
  stone.density_kg_m3 = 1000;
  stone.toughness_J_m2 = 100;
  stone.pattern.kind = PatternSpec::Kind::kVoronoi;
  scene.materials = {stone};
  scene.gravity_W = Vec3::Zero();
  scene.accuracy = {1.0 / 60, 1};
  return scene;
}

/// Returns a solid of `count` unit boxes in a row along x.
Solid row(const Vec3& low, int count, bool anchored) {
  Solid solid;
  for (int i = 0; i < count; ++i) {
    const Vec3 min = low + Vec3(i, 0, 0);
    solid.compound.convexes.push_back(
        make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
    solid.compound.anchored.push_back(anchored ? kAnchoredAllSides : 0);
  }
  return solid;
}

/// Simulation of a scene, with access to its scripted physics.
struct ActRun {
  explicit ActRun(Scene scene, double crack_m2 = 1, ScriptedPhysics::Script script = none) {
    auto owned = std::make_unique<ScriptedPhysics>(std::move(script));
    physics = owned.get();
    simulation = std::make_unique<Simulation>(std::move(scene), std::move(owned),
                                              std::make_unique<ScriptedBreaker>(crack_m2));
    simulation->next();
  }
  const BodyState& state(std::uint32_t key) const { return physics->find(key)->state; }

  ScriptedPhysics* physics;
  std::unique_ptr<Simulation> simulation;
};

TEST(Blast, PushesEachFaceTurnedTowardsItByAreaAndDistance) {
  Scene scene = empty_scene();
  scene.materials[0].pattern.kind = PatternSpec::Kind::kNone;
  scene.solids = {row(Vec3(2, -0.5, -0.5), 1, false), row(Vec3(-4, -0.5, -0.5), 1, false),
                  row(Vec3(20, 0, 0), 1, false)};
  scene.blasts = {{0, Vec3::Zero(), 5, 1000}};
  ActRun run(scene);
  for (int i = 0; i < 5; ++i) run.simulation->next();
  // The blast reaches only the face at x = 2: 1 m², 2 of 5 metres away; 1000 kg.
  EXPECT_NEAR(run.state(0).velocity_W.x(), 0.6 * 0.6, 1e-9);
  EXPECT_NEAR(run.state(1).velocity_W.x(), -0.4 * 0.4, 1e-9);
  EXPECT_EQ(run.state(2).velocity_W.norm(), 0) << "out of reach";
  for (int i = 0; i < 5; ++i) run.simulation->next();
  EXPECT_NEAR(run.state(0).velocity_W.x(), 0.6 * 0.6, 1e-9) << "the blast pushes once";
}

TEST(Blast, WithCoverPushesOnlyBodiesInLineOfSight) {
  for (const bool cover : {false, true}) {
    Scene scene = empty_scene();
    scene.materials[0].pattern.kind = PatternSpec::Kind::kNone;
    // One box behind another, one at an equal distance to the side, and a ball behind both.
    scene.solids = {row(Vec3(1, -0.5, -0.5), 1, true), row(Vec3(2.5, -0.5, -0.5), 1, false),
                    row(Vec3(-0.5, -0.5, 2.5), 1, false)};
    scene.balls = {{"ball", 0.25, MaterialIndex(0), Vec3(4, 0, 0), Vec3::Zero()}};
    scene.blasts = {{0, Vec3::Zero(), 5, 1000, cover}};
    ActRun run(scene);
    for (int i = 0; i < 5; ++i) run.simulation->next();
    const double free_m_s = 0.5 * 0.5;  // 2.5 of 5 metres away
    EXPECT_NEAR(run.state(1).velocity_W.x(), cover ? 0 : free_m_s, 1e-9);
    EXPECT_NEAR(run.state(2).velocity_W.z(), free_m_s, 1e-9);
    EXPECT_EQ(run.state(3).velocity_W.norm() > 0, !cover);
  }
}

TEST(Blast, CoverHasTheDirectionOfWhatCovers) {
  Random random(1, 0);
  for (int i = 0; i < 30; ++i) {
    const Vec3 direction = random.direction();
    const Vec3 aside = (direction + 0.6 * direction.unitOrthogonal()).normalized();
    Scene scene = empty_scene();
    scene.materials[0].pattern.kind = PatternSpec::Kind::kNone;
    scene.solids = {row(2 * direction - Vec3::Constant(0.5), 1, true)};
    scene.balls = {{"behind", 0.1, MaterialIndex(0), 4 * direction, Vec3::Zero()},
                   {"aside", 0.1, MaterialIndex(0), 4 * aside, Vec3::Zero()}};
    scene.blasts = {{0, Vec3::Zero(), 5, 1000, true}};
    ActRun run(scene);
    for (int frame = 0; frame < 5; ++frame) run.simulation->next();
    EXPECT_EQ(run.state(1).velocity_W.norm(), 0) << direction.transpose();
    EXPECT_GT(run.state(2).velocity_W.norm(), 0) << direction.transpose();
  }
}

/// Returns a thousand boxes of 1 m at the points of a grid, with a blast between two that reaches
/// them all.
Scene thousand_boxes() {
  Scene scene = empty_scene();
  scene.materials[0].pattern.kind = PatternSpec::Kind::kNone;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 cell(i % 10, i / 10 % 10, i / 100);
    scene.solids.push_back(row(1.7 * (cell - Vec3::Constant(4.5)) - Vec3::Constant(0.5), 1, false));
  }
  scene.blasts = {{0, Vec3(0, 0.85, 0.85), 20, 1000, true}};
  return scene;
}

TEST(Blast, CoverAmongAThousandBoxesTakesAFewRaysForEachDirectionWhichAreCounted) {
  constexpr std::uint64_t kDirections = 6 * 48 * 48;
  ActRun run(thousand_boxes());
  std::uint64_t rays = 0, points = 0;
  for (int i = 0; i < 5; ++i)
    for (const WorkItem& item : run.simulation->next()->report.work) {
      if (item.stage != Stage::kAct) continue;
      (std::string_view(item.name) == "rays for cover" ? rays : points) += item.count;
    }
  EXPECT_GT(rays, kDirections);
  EXPECT_LT(rays, 3 * kDirections);
  EXPECT_EQ(points, 6000u) << "six faces of each box, once";
}

TEST(Blast, WithCoverPushesTheSameForAnyNumberOfThreads) {
  std::vector<std::vector<Vec3>> all;
  for (const int count : {1, 3}) {
    const ThreadScope scope(count);
    ActRun run(thousand_boxes());
    for (int i = 0; i < 5; ++i) run.simulation->next();
    std::vector<Vec3>& velocities = all.emplace_back();
    for (std::uint32_t key = 0; key < 1000; ++key) velocities.push_back(run.state(key).velocity_W);
  }
  EXPECT_EQ(all[0], all[1]);
  const auto moved = std::ranges::count_if(all[0], [](const Vec3& v) { return v.norm() > 0; });
  EXPECT_GT(moved, 8);
  EXPECT_LT(moved, 500) << "most are covered";
}

TEST(Blast, InsideASolidWhoseFacesAllPointAwayAppliesNoImpulse) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3::Constant(-0.5), 1, false)};
  scene.blasts = {{0, Vec3::Zero(), 5, 1000}};
  ActRun run(scene);
  for (int i = 0; i < 5; ++i) run.simulation->next();
  EXPECT_EQ(run.state(0).velocity_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(run.state(0).angular_velocity_W, Vec3(Vec3::Zero()));
}

TEST(Blast, BreaksASolidIfItsEnergyExceedsTheCrackEnergy) {
  // For i N·s/m², each box gets 0.36 i N·s: 0.065 i² / 1000 J together; the crack takes 100 J.
  for (const double impulse : {500.0, 5000.0}) {
    Scene scene = empty_scene();
    scene.materials[0].impact_radius_m = 10;
    scene.solids = {row(Vec3(-1, -0.5, 2), 2, true)};
    scene.blasts = {{0, Vec3::Zero(), 5, impulse}};
    ActRun run(scene, 1);
    const FramePtr frame = run.simulation->next();
    EXPECT_EQ(frame->breaks.size(), impulse > 1000 ? 1u : 0u) << impulse;
    EXPECT_EQ(frame->report.mass_kg, 2000);
  }
}

TEST(Blast, TwoAtOnceBothPush) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3(2, -0.5, -0.5), 1, false)};
  scene.blasts = {{0, Vec3::Zero(), 5, 1000}, {0, Vec3::Zero(), 5, 500}};
  ActRun run(scene);
  for (int i = 0; i < 5; ++i) run.simulation->next();
  EXPECT_NEAR(run.physics->bodies.back().state.velocity_W.norm(), 1.5 * 0.36, 1e-9);
}

TEST(Removal, OfASolidRemovesItsPiecesTooAndTheMassIsAccountedFor) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3::Zero(), 2, false), row(Vec3(0, 5, 0), 1, false)};
  scene.balls = {{"ball", 0.25, MaterialIndex(0), Vec3(-0.3, 0.5, 0.5), Vec3(60, 0, 0)}};
  scene.removals = {{1.5 / 60, {0}, {}}};
  ActRun run(scene, 0.1, [](const ScriptedPhysics& physics, int) {
    return physics.approach(2, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX());
  });
  FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->bodies.size(), 4u) << "two pieces, the other solid, the ball";
  const double mass = frame->report.mass_kg;
  run.simulation->next();
  frame = run.simulation->next();
  ASSERT_EQ(frame->bodies.size(), 2u);
  EXPECT_EQ(frame->bodies[0].key, 1u);
  EXPECT_NEAR(frame->report.mass_kg, mass, 1e-9);
}

TEST(Removal, OfAnchorsFreesSolidsWithoutOtherAnchors) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3::Zero(), 3, true), row(Vec3(0, 3, 0), 2, true)};
  Removal removal;
  removal.anchors_W.extend(Vec3(-1, -1, -1));
  removal.anchors_W.extend(Vec3(2, 5, 2));  // two of the first three, both of the others
  scene.removals = {removal};
  ActRun run(scene);
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->bodies.size(), 2u);
  EXPECT_TRUE(frame->bodies[0].is_static) << "its third box is anchored still";
  EXPECT_FALSE(frame->bodies[1].is_static);
}

TEST(Drive, ReachesItsVelocityWithAtMostItsForce) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3::Zero(), 1, false)};  // 1000 kg
  scene.drives = {{0.5, 1.5, {0}, Vec3(2, 0, 0), 3000}};
  ActRun run(scene);
  for (int i = 0; i < 60; ++i) run.simulation->next();
  EXPECT_NEAR(run.state(0).velocity_W.x(), 1.5, 0.06) << "half a second at 3 m/s²";
  for (int i = 0; i < 20; ++i) run.simulation->next();
  EXPECT_NEAR(run.state(0).velocity_W.x(), 2, 1e-9);
}

TEST(Drive, ReachesItsSpinWithAtMostItsTorqueAndAppliesNoForce) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3::Zero(), 1, false)};  // 1000 kg, 1 m: 167 kg m²
  const Vec3 axis = Vec3(2, 1, -2) / 3;
  scene.drives = {{0.5, 1.5, {0}, std::nullopt, 0, 2 * axis, 500}};
  ActRun run(scene);
  for (int i = 0; i < 60; ++i) run.simulation->next();
  EXPECT_LT((run.state(0).angular_velocity_W - 1.5 * axis).norm(), 0.06)
      << "half a second at 3 rad/s²";
  for (int i = 0; i < 20; ++i) run.simulation->next();
  EXPECT_LT((run.state(0).angular_velocity_W - 2 * axis).norm(), 1e-9);
  EXPECT_LT(run.state(0).velocity_W.norm(), 1e-9);
}

TEST(WreckingBall, HangsOnARopeToItsCentre) {
  Scene scene = empty_scene();
  scene.shots = {
      {0, {"ball", 0.5, MaterialIndex(0), Vec3(3, 0, 0), Vec3(0, 2, 0)}, Vec3(Vec3::Zero())}};
  ActRun run(scene);
  run.simulation->world().step(1.0 / 120);
  ASSERT_EQ(run.physics->joints.size(), 1u);
  const JointDesc& rope = run.physics->joints[0];
  EXPECT_EQ(rope.kind, JointDesc::Kind::kRope);
  EXPECT_TRUE(rope.a.none());
  EXPECT_EQ(rope.length_m, 3);
  EXPECT_TRUE(rope.anchor_b_R.isZero());
}

TEST(WreckingBall, HangsOnAChainThatReachesItsSurface) {
  Scene scene = empty_scene();
  Shot shot{0, {"ball", 0.5, MaterialIndex(0), Vec3(0, -3, 0), Vec3::Zero()}, Vec3(Vec3::Zero())};
  for (int i = 0; i < 5; ++i) {
    shot.links.push_back(row(Vec3(-0.5, -0.5, -0.5), 1, false));
    shot.links.back().X_WR.position = Vec3(0, -0.25 - 0.5 * i, 0);
  }
  scene.shots = {shot};
  ActRun run(scene);
  const double before = run.simulation->next()->report.mass_kg;
  run.simulation->world().step(1.0 / 120);
  ASSERT_EQ(run.physics->joints.size(), 6u);
  EXPECT_LT((run.physics->joints[5].anchor_b_R - Vec3(0, 0.5, 0)).norm(), 1e-12);
  EXPECT_LT((run.physics->joints[5].anchor_a_R - Vec3(0, -0.25, 0)).norm(), 1e-12);
  EXPECT_NEAR(run.simulation->next()->report.mass_kg, before, 1e-9 * before)
      << "the mass of the ball and its chain is counted from the start";
}

TEST(Joint, FollowsThePieceThatHasItsAnchorOrIsRemoved) {
  Scene scene = empty_scene();
  scene.solids = {row(Vec3(0, 0, 0), 3, false)};
  scene.balls = {{"ball", 0.25, MaterialIndex(0), Vec3(-0.3, 0.5, 0.5), Vec3(60, 0, 0)}};
  Joint at_end;  // at the far end, a little outside
  at_end.a = 0;
  at_end.at_W = Vec3(3.001, 0.5, 0.5);
  Joint beside = at_end;  // 1 m above the solid: no convex is near
  beside.at_W = Vec3(1.5, 2, 0.5);
  scene.joints = {at_end, beside};
  ActRun run(scene, 0.01, [](const ScriptedPhysics& scripted, int) {
    return scripted.approach(1, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX());
  });
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->breaks.size(), 1u);
  EXPECT_EQ(frame->report.joints_lost, 1u);
  EXPECT_FALSE(run.physics->cut_joints[0]);
  EXPECT_TRUE(run.physics->cut_joints[1]);
  const ScriptedPhysics::Body& body = run.physics->bodies[run.physics->joints[0].a.slot];
  EXPECT_TRUE(body.alive);
  EXPECT_NEAR(body.desc.com_R.x(), 2.5, 1e-9) << "the last of the three";
}

/// Twenty boxes of different heights, separated from one another by a break and asleep.
struct Rubble : ActRun {
  static Scene scene_of(Limits limits) {
    Scene scene = empty_scene();
    Solid solid;
    for (int i = 0; i < 20; ++i) {
      const Vec3 min(2 * i, 0, 0);
      solid.compound.convexes.push_back(make_convex(
          make_box(min, min + Vec3(1, 1, 0.1 + 0.05 * ((7 * i) % 20))), MaterialIndex(0)));
      solid.compound.anchored.push_back(0);
    }
    scene.solids = {solid};
    scene.balls = {{"ball", 0.25, MaterialIndex(0), Vec3(-0.3, 0.5, 0.05), Vec3(60, 0, 0)}};
    scene.limits = limits;
    return scene;
  }
  explicit Rubble(Limits limits)
      : ActRun(scene_of(limits), 0.01, [](const ScriptedPhysics& scripted, int) {
          return scripted.approach(1, 0, Vec3(0, 0.5, 0.05), Vec3::UnitX());
        }) {
    parted = simulation->next();
    for (auto& body : physics->bodies) body.state.asleep = body.desc.tag != 1;
  }
  FramePtr parted;
};

TEST(Ageing, MakesDebrisOfTheSmallestFragmentsAtRestAndKeepsTheMass) {
  Limits limits;
  limits.ageing = 16;
  Rubble rubble(limits);
  ASSERT_EQ(rubble.parted->bodies.size(), 21u);
  const FramePtr frame = rubble.simulation->next();
  EXPECT_EQ(frame->bodies.size(), 14u) << "two fewer than limits.ageing";
  EXPECT_EQ(frame->report.aged, 7u);
  EXPECT_NEAR(frame->report.mass_kg, rubble.parted->report.mass_kg, 1e-9);
  double smallest_left = 1e9;
  for (const auto& body : rubble.physics->bodies) {
    if (body.alive && !body.desc.is_static && body.desc.tag > 1) {
      smallest_left = std::min(smallest_left, body.desc.mass_kg);
    }
  }
  EXPECT_NEAR(smallest_left, 1000 * (0.1 + 0.05 * 7), 1e-6) << "the seven smallest were removed";
  EXPECT_EQ(rubble.simulation->next()->report.aged, 0u);
}

TEST(Ageing, LeavesMovingBodiesAndWholeSolids) {
  Limits limits;
  limits.ageing = 16;
  Rubble rubble(limits);
  for (auto& body : rubble.physics->bodies) body.state.asleep = false;
  EXPECT_EQ(rubble.simulation->next()->report.aged, 0u);
  Scene scene = empty_scene();
  for (int i = 0; i < 20; ++i) scene.solids.push_back(row(Vec3(2 * i, 0, 0), 1, false));
  scene.limits.ageing = 16;
  ActRun whole(scene);
  for (auto& body : whole.physics->bodies) body.state.asleep = true;
  EXPECT_EQ(whole.simulation->next()->bodies.size(), 20u);
}

TEST(Ageing, BelowTheLimitDoesNothing) {
  Rubble rubble(Limits{});
  EXPECT_EQ(rubble.simulation->next()->bodies.size(), 21u);
}

TEST(Joint, ABodyFixedToTheWorldBearsTheWholeImpactWhateverItsMass) {
  for (const double energy_J : {25.0, 45.0}) {
    Scene scene = empty_scene();
    scene.materials[0].impact_radius_m = 10;  // the smallest crack takes 16 J
    Material lead;
    lead.density_kg_m3 = 80000;
    scene.materials.push_back(lead);
    scene.solids = {row(Vec3(0, -0.5, -0.5), 2, false)};
    Joint joint;
    joint.kind = JointKind::kFixed;
    joint.a = 0;
    joint.at_W = Vec3(1, 0, 0);
    scene.joints = {joint};
    const double radius_m = 0.25, ball_kg = 80000 * 4.0 / 3 * 3.14159265 * std::pow(radius_m, 3);
    const double speed_m_s = std::sqrt(2 * energy_J / ball_kg);
    scene.balls = {{"ball", radius_m, MaterialIndex(1), Vec3(-0.26, 0, 0), Vec3(speed_m_s, 0, 0)}};
    ActRun run(scene, 0.3, [](const ScriptedPhysics& physics, int) {  // a crack of 30 J
      return physics.approach(1, 0, Vec3::Zero(), Vec3::UnitX());
    });
    EXPECT_EQ(run.simulation->next()->breaks.size(), energy_J > 30 ? 1u : 0u) << energy_J;
  }
}

/// Scripted physics that keeps the joints of the last probe.
class ProbedPhysics : public ScriptedPhysics {
 public:
  using ScriptedPhysics::ScriptedPhysics;
  std::unique_ptr<ImpactProbe> probe(ProbeCluster cluster) const override {
    joints_probed = cluster.joints;
    return ScriptedPhysics::probe(std::move(cluster));
  }
  mutable std::vector<ProbeJoint> joints_probed;
};

TEST(Joint, IsProbedWithItsArmsAboutBothBodies) {
  Scene scene = empty_scene();
  scene.materials[0].impact_radius_m = 10;
  scene.solids = {row(Vec3(0, -0.5, -0.5), 2, false), row(Vec3(2.5, -0.5, -0.5), 1, false)};
  Joint joint;
  joint.kind = JointKind::kFixed;
  joint.a = 0;
  joint.b = 1;
  joint.at_W = Vec3(2.25, 0.2, 0);
  scene.joints = {joint};
  scene.balls = {{"ball", 0.25, MaterialIndex(0), Vec3(-0.26, 0, 0), Vec3(3, 0, 0)}};
  auto owned = std::make_unique<ProbedPhysics>([](const ScriptedPhysics& physics, int) {
    return physics.approach(2, 0, Vec3::Zero(), Vec3::UnitX());
  });
  const ProbedPhysics& physics = *owned;
  Simulation simulation(std::move(scene), std::move(owned), std::make_unique<ScriptedBreaker>(1));
  simulation.next();
  simulation.next();
  ASSERT_EQ(physics.joints_probed.size(), 1u);
  EXPECT_LT((physics.joints_probed[0].arm_a_W - Vec3(1.25, 0.2, 0)).norm(), 1e-12);
  EXPECT_LT((physics.joints_probed[0].arm_b_W - Vec3(-0.75, 0.2, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace sunder
