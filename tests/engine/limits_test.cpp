// Tests that the limits of a run are counted by name when it reaches them, with scripted physics
// and breaker; tests/solver/limits_test.cpp has those of the solver.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;
using Names = std::map<std::string, std::uint32_t>;
using Contacts = std::vector<SpeculativeContact>;

Names names(const Frame& frame) {
  Names all;
  frame.report.limits.for_each(
      [&](const LimitText& text, std::uint32_t count) { all[text.name] = count; });
  return all;
}

/// Returns boxes of 1 m in a row along x, each bonded to the next, the first at `low`.
Compound row_of_boxes(int count, const Vec3& low = Vec3::Zero()) {
  Compound compound;
  for (int i = 0; i < count; ++i) {
    const Vec3 min = low + Vec3(i, 0, 0);
    compound.convexes.push_back(make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
    compound.anchored.push_back(false);
    const auto self = static_cast<std::uint32_t>(i);
    if (i > 0) compound.bonds.push_back({self - 1, self, 1, 0, 1});
  }
  return compound;
}

/// Returns a scene of brittle stone, with a pattern, and steel, that breaks at 200 J per solid of
/// two boxes.
Scene scene_of(std::vector<Solid> solids, std::vector<Ball> balls) {
  Scene scene;
  Material stone;
  stone.name = "stone";
  stone.density_kg_m3 = 1000;
  stone.toughness_J_m2 = 100;
  stone.pattern.kind = PatternSpec::Kind::kVoronoi;
  Material steel;
  steel.name = "steel";
  steel.density_kg_m3 = 8000;
  scene.materials = {stone, steel};
  scene.gravity_W = Vec3::Zero();
  scene.accuracy = {1.0 / 60, 1};
  scene.solids = std::move(solids);
  scene.balls = std::move(balls);
  return scene;
}

Ball ball_at(const Vec3& center, const Vec3& velocity) {
  return {"ball", 0.25, MaterialIndex(1), center, velocity};
}

/// A ball whose energy makes that of all other impacts small.
Ball passing_by() { return ball_at(Vec3(0, 1000, 0), Vec3(0, 3000, 0)); }

using Stressed = std::function<StressResult(const Structure&, const LoadCase&)>;

/// Simulation with access to its physics.
struct LimitsRun {
  ScriptedPhysics* physics = nullptr;
  std::unique_ptr<Simulation> simulation;
  FramePtr first;  ///< Frame 0.

  LimitsRun(Scene scene, ScriptedPhysics::Script script, Stressed stressed = nullptr) {
    auto owned = std::make_unique<ScriptedPhysics>(std::move(script));
    physics = owned.get();
    auto breaker = std::make_unique<ScriptedBreaker>(2.0);
    breaker->stressed = std::move(stressed);
    simulation =
        std::make_unique<Simulation>(std::move(scene), std::move(owned), std::move(breaker));
    first = simulation->next();
  }
};

Contacts no_contacts(const ScriptedPhysics&, int) { return {}; }

/// Returns a script of several contacts at every collide.
ScriptedPhysics::Script joined(std::vector<ScriptedPhysics::Script> scripts) {
  return [=](const ScriptedPhysics& physics, int collides) {
    Contacts all;
    for (const auto& script : scripts)
      for (const SpeculativeContact& contact : script(physics, collides)) all.push_back(contact);
    return all;
  };
}

ScriptedPhysics::Script always(std::uint32_t a, std::uint32_t b, Vec3 point, Vec3 normal,
                               double separation_m = 0) {
  return [=](const ScriptedPhysics& physics, int) {
    Contacts found = physics.approach(a, b, point, normal);
    for (SpeculativeContact& contact : found) contact.separation_m = separation_m;
    return found;
  };
}

Scene struck_box(double speed_m_s = 9) {
  return scene_of({{"box", row_of_boxes(2), {}}},
                  {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(speed_m_s, 0, 0))});
}

const ScriptedPhysics::Script kStrike = always(1, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX());

TEST(Limits, ARunThatReachesNoneCountsNone) {
  LimitsRun run(struck_box(), kStrike);
  EXPECT_EQ(names(*run.first), Names());
  const FramePtr frame = run.simulation->next();
  EXPECT_EQ(frame->breaks.size(), 1u);
  EXPECT_EQ(names(*frame), Names());
  EXPECT_EQ(frame->report.limits_hit, 0u);
}

TEST(Limits, ABreakIntoTooManyBodiesIsCounted) {
  Scene scene = struck_box();
  scene.limits.bodies = 2;
  LimitsRun run(scene, kStrike);
  const FramePtr frame = run.simulation->next();
  EXPECT_TRUE(frame->breaks.empty());
  EXPECT_EQ(names(*frame), (Names{{"bodies", 1}}));
  EXPECT_EQ(frame->report.limits_hit, 1u);
}

TEST(Limits, ASolidWithTooManyBondsForStressByImpactIsCountedOnceWhenItIsMade) {
  for (const std::uint32_t bonds : {2u, 1u}) {
    Scene scene = scene_of({{"bar", row_of_boxes(3), {}}}, {});
    scene.materials[0].tensile_Pa = 1e6;
    scene.limits.impact_bonds = bonds;
    LimitsRun run(scene, no_contacts);
    EXPECT_EQ(names(*run.first), bonds == 2 ? Names() : (Names{{"impact_bonds", 1}}));
    EXPECT_EQ(names(*run.simulation->next()), Names());
  }
}

TEST(Limits, SmallPiecesAreCountedByNameButNeitherSummedNorWarnedOf) {
  const auto halves = [](const Structure& structure, const LoadCase&) {
    StressResult answer;
    answer.settled = true;
    if (structure.size() < 4) return answer;
    answer.edit.changed = true;
    for (std::uint32_t i = 0; i < 4; ++i) answer.edit.removed.emplace_back(i);
    for (const std::uint32_t first : {0u, 2u}) {
      const ConvexSlot a(first), b(first + 1);
      answer.edit.loose.pieces.push_back(
          {{structure.convex(a), structure.convex(b)}, {0, 0}, {{0, 1, 1, 0, 1}}, {}});
    }
    return answer;
  };
  for (const std::uint32_t least : {2u, 3u}) {
    Scene scene = scene_of({{"bar", row_of_boxes(4), {}}}, {});
    scene.materials[0].tensile_Pa = 1e6;
    scene.limits.loaded_convexes = least;
    LimitsRun run(scene, no_contacts, halves);
    run.physics->loads = {{0, 1, Vec3(0, -1000, 0), Vec3(1, 1, 0)}};
    const FramePtr frame = run.simulation->next();
    ASSERT_EQ(frame->bodies.size(), 2u);
    EXPECT_EQ(names(*frame), least == 2 ? Names() : (Names{{"loaded_convexes", 2}}));
    EXPECT_EQ(frame->report.limits_hit, 0u);
  }
}

TEST(Limits, AClusterOfTheLargestSizeIsCounted) {
  for (const std::uint32_t bodies : {4u, 2u}) {
    Scene scene = scene_of({{"struck", row_of_boxes(2), {}},
                            {"behind", row_of_boxes(2, Vec3(2, 0, 0)), {}, Vec3(-0.01, 0, 0)}},
                           {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))});
    scene.limits.cluster_bodies = bodies;
    LimitsRun run(scene, joined({always(2, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX()),
                                 always(0, 1, Vec3(2, 0.5, 0.5), Vec3::UnitX())}));
    EXPECT_EQ(names(*run.simulation->next()),
              bodies == 4 ? Names() : (Names{{"cluster_bodies", 1}}));
  }
}

TEST(Limits, AClusterWithMoreEventsThanAllowedIsCounted) {
  for (const std::uint32_t events : {24u, 1u}) {
    // The first box holds, and strikes the second one within the step.
    Scene scene = scene_of({{"first", row_of_boxes(2), {}, Vec3(1, 0, 0)},
                            {"second", row_of_boxes(2, Vec3(2.01, 0, 0)), {}}},
                           {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(1.5, 0, 0))});
    scene.limits.probe_events = events;
    LimitsRun run(scene, joined({always(2, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX()),
                                 always(0, 1, Vec3(2, 0.5, 0.5), Vec3::UnitX(), 0.01)}));
    const FramePtr frame = run.simulation->next();
    EXPECT_EQ(frame->breaks.empty(), events == 1);
    EXPECT_EQ(names(*frame), events == 24 ? Names() : (Names{{"probe_events", 1}}));
  }
}

TEST(Limits, AnImpactThatIsUndecidedAfterTheLastRoundIsCounted) {
  for (const std::uint32_t rounds : {8u, 1u}) {
    Scene scene =
        scene_of({{"front", row_of_boxes(2), {}}, {"back", row_of_boxes(2, Vec3(0, 0, -2)), {}}},
                 {ball_at(Vec3(0.5, 0.5, 1.3), Vec3(0, 0, -30)), passing_by()});
    scene.limits.break_rounds = rounds;
    LimitsRun run(scene, [](const ScriptedPhysics& physics, int collides) {
      return physics.approach(2, collides == 0 ? 0 : 1, Vec3(0.5, 0.5, collides == 0 ? 1 : -1),
                              -Vec3::UnitZ());
    });
    const FramePtr frame = run.simulation->next();
    EXPECT_EQ(frame->breaks.size(), rounds == 8 ? 2u : 1u);
    EXPECT_EQ(names(*frame), rounds == 8 ? Names() : (Names{{"break_rounds", 1}}));
    EXPECT_EQ(frame->report.carried_over, 0u);
  }
}

TEST(Limits, SmallImpactsThatTheBudgetDoesNotCoverAreCounted) {
  Scene scene =
      scene_of({{"front", row_of_boxes(2), {}}, {"back", row_of_boxes(2, Vec3(0, 0, -2)), {}}},
               {ball_at(Vec3(-0.25, 0.5, 0.5), Vec3(30, 0, 0)),
                ball_at(Vec3(-0.25, 0.5, -1.5), Vec3(20, 0, 0)), passing_by()});
  scene.limits.parts_a_frame = static_cast<std::uint32_t>(scene.materials[0].pattern.cells);
  LimitsRun run(scene, joined({always(2, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX()),
                               always(3, 1, Vec3(0, 0.5, -1.5), Vec3::UnitX())}));
  const FramePtr frame = run.simulation->next();
  EXPECT_EQ(frame->breaks.size(), 1u);
  EXPECT_EQ(frame->report.carried_over, 0u);
  // Once when it was planned, and once when it was found again after the break.
  EXPECT_EQ(names(*frame), (Names{{"parts_a_frame", 2}}));
}

TEST(Limits, AnImpactWhoseStressIsNotFoundIsCounted) {
  for (const bool gave_up : {false, true}) {
    Scene scene = struck_box();
    scene.materials[0].pattern.kind = PatternSpec::Kind::kNone;
    scene.materials[0].tensile_Pa = 1e5;
    LimitsRun run(scene, kStrike, [&](const Structure&, const LoadCase&) {
      StressResult answer;
      answer.gave_up = gave_up;
      return answer;
    });
    EXPECT_EQ(names(*run.simulation->next()),
              gave_up ? (Names{{"impact_evaluations", 1}}) : Names());
  }
}

TEST(Limits, ASteadyLoadWhoseStressDoesNotConvergeIsCounted) {
  Scene scene = scene_of({{"bar", row_of_boxes(2), {}}}, {});
  scene.materials[0].tensile_Pa = 1e6;
  scene.solids[0].compound.anchored[0] = true;
  LimitsRun run(scene, no_contacts, [&](const Structure&, const LoadCase&) {
    StressResult answer;
    answer.settled = answer.gave_up = true;
    return answer;
  });
  EXPECT_EQ(names(*run.simulation->next()), (Names{{"load_iterations", 1}}));
  EXPECT_EQ(names(*run.simulation->next()), Names()) << "the load does not change";
}

}  // namespace
}  // namespace sunder
