// Tests of the break stage and of Simulation, with scripted physics and breaker.
#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/model/piece_mesh.h"
#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

constexpr double kToughness = 100, kAreaPerPart = 2;  // 2 parts: 2 · 2 / 2 · 100 = 200 J

/// Returns two touching boxes along x, the first at `low`.
Compound two_boxes(const Vec3& low, bool anchored) {
  Compound compound;
  for (int i = 0; i < 2; ++i) {
    const Vec3 min = low + Vec3(i, 0, 0);
    compound.convexes.push_back(make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
    compound.anchored.push_back(anchored && i == 0);
  }
  return compound;
}

Scene scene_of(std::vector<Solid> solids, std::vector<Ball> balls) {
  Scene scene;
  Material stone;
  stone.name = "stone";
  stone.density_kg_m3 = 1000;
  stone.toughness_J_m2 = kToughness;
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

struct Sum {
  double mass = 0, kinetic = 0;
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();
};

Sum sum_of(const ScriptedPhysics& physics) {
  Sum sum;
  for (const auto& body : physics.bodies) {
    if (!body.alive || body.desc.is_static) continue;
    const BodyState& s = body.state;
    const Vec3 w_B = s.X_WB.rotation.conjugate() * s.angular_velocity_W;
    sum.mass += body.desc.mass_kg;
    sum.kinetic += 0.5 * body.desc.mass_kg * s.velocity_W.squaredNorm() +
                   0.5 * w_B.dot(body.desc.inertia_B * w_B);
    const Vec3 p = body.desc.mass_kg * s.velocity_W;
    sum.momentum += p;
    sum.spin += s.X_WB.position.cross(p) + s.X_WB.rotation * (body.desc.inertia_B * w_B);
  }
  return sum;
}

/// Simulation with access to its scripted physics.
struct ScriptedRun {
  ScriptedPhysics* physics;
  Simulation simulation;

  ScriptedRun(Scene scene, ScriptedPhysics::Script script)
      : ScriptedRun(std::move(scene), std::make_unique<ScriptedPhysics>(std::move(script))) {}

 private:
  ScriptedRun(Scene scene, std::unique_ptr<ScriptedPhysics> scripted)
      : physics(scripted.get()),
        simulation(std::move(scene), std::move(scripted),
                   std::make_unique<ScriptedBreaker>(kAreaPerPart)) {}
};

/// Returns a script of a contact of `a` and `b` at every collide(); keys are solids, then balls.
ScriptedPhysics::Script always(std::uint32_t a, std::uint32_t b, Vec3 point, Vec3 normal) {
  return [=](const ScriptedPhysics& physics, int) { return physics.approach(a, b, point, normal); };
}

Ball ball_at(const Vec3& center, const Vec3& velocity) {
  return {"ball", 0.25, MaterialIndex(1), center, velocity};
}

TEST(BreakStage, TakesExactlyTheCracksEnergyAndKeepsMomentum) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}, Vec3(0.5, 0, 0), Vec3(0, 0.3, 0.2)};
  ScriptedRun run(scene_of({solid}, {ball_at(Vec3(-0.3, 0.4, 0.7), Vec3(9, 1, 0))}),
                  always(1, 0, Vec3(0, 0.4, 0.7), Vec3(1, 0, 0)));
  run.simulation.next();
  const Sum before = sum_of(*run.physics);
  const FramePtr frame = run.simulation.next();
  Sum after = sum_of(*run.physics);
  ASSERT_EQ(frame->breaks.size(), 1u);
  EXPECT_NEAR(frame->breaks[0].energy_J, 200, 1e-9);
  EXPECT_NEAR(after.mass, before.mass, 1e-9 * before.mass);
  EXPECT_NEAR(before.kinetic - after.kinetic, 200, 1e-9 * before.kinetic);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-9 * before.momentum.norm());
}

TEST(BreakStage, KeepsAngularMomentumThroughTheBreakItself) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}, Vec3(0.5, 0, 0), Vec3(1, 2, 3)};
  ScriptedRun run(scene_of({solid}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))}),
                  always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
  run.simulation.next();
  const Sum before = sum_of(*run.physics);
  ASSERT_EQ(run.simulation.next()->breaks.size(), 1u);
  Sum after = sum_of(*run.physics);
  // The motion of the step, in a straight line, does not change angular momentum either.
  EXPECT_LT((after.spin - before.spin).norm(), 1e-9 * before.spin.norm());
}

TEST(BreakStage, AnImpactOfTooLittleEnergyBreaksNothing) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}};
  ScriptedRun run(scene_of({solid}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(0.6, 0, 0))}),
                  always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
  run.simulation.next();
  const FramePtr frame = run.simulation.next();
  EXPECT_TRUE(frame->breaks.empty());
  EXPECT_EQ(frame->report.counts.compounds, 1u);
}

TEST(BreakStage, AnImpactBelowTheStrengthBreaksNothing) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}};
  Scene scene = scene_of({solid}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))});
  scene.materials[0].strength_Ns = 1e6;
  ScriptedRun run(scene, always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
  run.simulation.next();
  EXPECT_TRUE(run.simulation.next()->breaks.empty());
}

TEST(BreakStage, BreaksAWeakSolidBesideOneThatIsTooStrong) {
  Solid strong{"strong", two_boxes(Vec3::Zero(), false), {}};
  strong.compound.convexes[0] = make_convex(make_box(Vec3::Zero(), Vec3::Ones()), MaterialIndex(2));
  const Solid weak{"weak", two_boxes(Vec3(3, 0, 0), false), {}};
  Ball ball = ball_at(Vec3(2, 0.5, 1.3), Vec3(0, 0, -30));
  Scene scene = scene_of({strong, weak}, {ball});
  scene.materials.push_back(scene.materials[0]);
  scene.materials[2].name = "granite";
  scene.materials[2].strength_Ns = 1e9;
  ScriptedRun run(scene, [](const ScriptedPhysics& physics, int) {
    std::vector<SpeculativeContact> both =
        physics.approach(2, 0, Vec3(0.5, 0.5, 1), Vec3(0, 0, -1));
    for (const SpeculativeContact& other :
         physics.approach(2, 1, Vec3(3.5, 0.5, 1), Vec3(0, 0, -1)))
      both.push_back(other);
    return both;
  });
  run.simulation.next();
  const FramePtr frame = run.simulation.next();
  ASSERT_EQ(frame->breaks.size(), 1u);
  EXPECT_EQ(frame->report.counts.compounds, 3u)
      << "two pieces of the weak solid, and the strong solid";
}

TEST(BreakStage, KeepsTheAnchoredPieceStaticAndFreesTheRest) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), true), {}};
  ScriptedRun run(scene_of({solid}, {ball_at(Vec3(2.3, 0.5, 0.5), Vec3(-9, 0, 0))}),
                  always(1, 0, Vec3(2, 0.5, 0.5), Vec3(-1, 0, 0)));
  run.simulation.next();
  const FramePtr frame = run.simulation.next();
  ASSERT_EQ(frame->bodies.size(), 3u);
  EXPECT_FALSE(frame->bodies[0].is_static);  // the ball is older than the pieces
  EXPECT_TRUE(frame->bodies[1].is_static);
  EXPECT_FALSE(frame->bodies[2].is_static);
}

TEST(BreakStage, BreaksTwoSolidsBehindEachOtherInOneStep) {
  const Solid front{"front", two_boxes(Vec3::Zero(), false), {}};
  const Solid back{"back", two_boxes(Vec3(0, 0, -2), false), {}};
  const auto script = [](const ScriptedPhysics& physics, int collides) {
    return collides == 0 ? physics.approach(2, 0, Vec3(0.5, 0.5, 1), Vec3(0, 0, -1))
                         : physics.approach(2, 1, Vec3(0.5, 0.5, -1), Vec3(0, 0, -1));
  };
  ScriptedRun run(scene_of({front, back}, {ball_at(Vec3(0.5, 0.5, 1.3), Vec3(0, 0, -30))}), script);
  run.simulation.next();
  const double before = sum_of(*run.physics).kinetic;
  const FramePtr frame = run.simulation.next();
  ASSERT_EQ(frame->breaks.size(), 2u);
  EXPECT_NEAR(before - sum_of(*run.physics).kinetic, 400, 1e-6);
}

TEST(BreakStage, DefersBreaksOverTheBudgetAndLosesNoEnergy) {
  const Solid front{"front", two_boxes(Vec3::Zero(), false), {}};
  const Solid back{"back", two_boxes(Vec3(0, 0, -2), false), {}};
  Scene scene = scene_of({front, back}, {ball_at(Vec3(-0.25, 0.5, 0.5), Vec3(30, 0, 0)),
                                         ball_at(Vec3(-0.25, 0.5, -1.5), Vec3(20, 0, 0))});
  scene.limits.parts_a_frame = static_cast<std::uint32_t>(scene.materials[0].pattern.cells);
  const auto script = [](const ScriptedPhysics& physics, int) {
    std::vector<SpeculativeContact> both = physics.approach(2, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0));
    const auto second = physics.approach(3, 1, Vec3(0, 0.5, -1.5), Vec3(1, 0, 0));
    both.insert(both.end(), second.begin(), second.end());
    return both;
  };
  ScriptedRun run(scene, script);
  run.simulation.next();
  const double before = sum_of(*run.physics).kinetic;
  const FramePtr first = run.simulation.next();
  ASSERT_EQ(first->breaks.size(), 1u);
  EXPECT_EQ(first->breaks[0].parent_key, 0u);  // the harder impact first
  EXPECT_EQ(first->report.carried_over, 1u);
  const BodyState deferred = run.physics->find(3)->state;
  EXPECT_EQ(deferred.velocity_W, Vec3(20, 0, 0));
  EXPECT_EQ(deferred.X_WB.position, Vec3(-0.25, 0.5, -1.5));
  const FramePtr second = run.simulation.next();
  EXPECT_EQ(second->breaks.size(), 1u);
  EXPECT_EQ(second->report.carried_over, 0u);
  EXPECT_NEAR(before - sum_of(*run.physics).kinetic, 400, 1e-6);
}

TEST(BreakStage, PlansNoBreakTwiceInAStepThatBreaksElsewhere) {
  const Solid breaks{"breaks", two_boxes(Vec3::Zero(), false), {}};
  const Solid holds{"holds", two_boxes(Vec3(0, 0, -2), false), {}};
  const Scene scene = scene_of({breaks, holds}, {ball_at(Vec3(-0.25, 0.5, 0.5), Vec3(30, 0, 0)),
                                                 ball_at(Vec3(-0.25, 0.5, -1.5), Vec3(0.9, 0, 0))});
  ScriptedRun run(scene, [](const ScriptedPhysics& physics, int) {
    std::vector<SpeculativeContact> both = physics.approach(2, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0));
    const auto second = physics.approach(3, 1, Vec3(0, 0.5, -1.5), Vec3(1, 0, 0));
    both.insert(both.end(), second.begin(), second.end());
    return both;
  });
  run.simulation.next();
  const FramePtr frame = run.simulation.next();
  ASSERT_EQ(frame->breaks.size(), 1u);
  const auto counted = [&](std::string_view name) {
    const auto is_it = [&](const WorkItem& item) { return item.name == name; };
    return std::ranges::find_if(frame->report.work, is_it)->count;
  };
  EXPECT_EQ(counted("clusters found"), 3u)
      << "the cluster that does not break is found again after the break";
  EXPECT_EQ(counted("breaks planned"), 2u) << "and is not planned again";
}

TEST(BreakStage, BreaksDeferredImpactsBeforeNewHarderOnes) {
  std::vector<Solid> solids;
  std::vector<Ball> balls;
  for (int i = 0; i < 3; ++i) {
    const Vec3 low(0, 0, -3 * i);
    solids.push_back({"box", two_boxes(low, false), {}});
    balls.push_back(ball_at(low + Vec3(-0.25, 0.5, 0.5), Vec3(30 + (i == 1 ? -5 : 5 * i), 0, 0)));
  }
  Scene scene = scene_of(solids, balls);
  scene.limits.parts_a_frame = static_cast<std::uint32_t>(scene.materials[0].pattern.cells);
  bool all_meet = false;  // the third ball is left out at first
  ScriptedRun run(scene, [&](const ScriptedPhysics& physics, int) {
    std::vector<SpeculativeContact> found;
    for (std::uint32_t i = 0; i < (all_meet ? 3u : 2u); ++i) {
      const auto one = physics.approach(3 + i, i, Vec3(0, 0.5, 0.5 - 3.0 * i), Vec3::UnitX());
      found.insert(found.end(), one.begin(), one.end());
    }
    return found;
  });
  run.simulation.next();
  const auto broken = [&] {
    const FramePtr frame = run.simulation.next();
    return frame->breaks.size() == 1 ? static_cast<int>(frame->breaks[0].parent_key) : -1;
  };
  EXPECT_EQ(broken(), 0) << "the harder one of two";
  all_meet = true;
  EXPECT_EQ(broken(), 1) << "the deferred one";
  EXPECT_EQ(broken(), 2);
}

TEST(BreakStage, BreaksASolidOfExactlyTheSmallestVolumeThatBreaks) {
  for (const double smallest_m3 : {2.0, 2.01}) {
    const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}};
    Scene scene = scene_of({solid}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))});
    scene.materials[0].smallest_break_m3 = smallest_m3;
    ScriptedRun run(scene, always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
    run.simulation.next();
    EXPECT_EQ(run.simulation.next()->breaks.size(), smallest_m3 > 2 ? 0u : 1u);
  }
}

TEST(BreakStage, CountsABreakThatTheBodyLimitForbids) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}};
  Scene scene = scene_of({solid}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))});
  scene.limits.bodies = 2;
  ScriptedRun run(scene, always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
  run.simulation.next();
  const FramePtr frame = run.simulation.next();
  EXPECT_TRUE(frame->breaks.empty());
  EXPECT_EQ(frame->report.limits_hit, 1u);
  EXPECT_EQ(frame->report.limits[Limit::kBodies], 1u);
}

TEST(Simulation, GivesAFrameEverySixtiethOfASecondUntilTheEnd) {
  Scene scene = scene_of({}, {ball_at(Vec3::Zero(), Vec3(1, 0, 0))});
  scene.duration_s = 0.5;
  scene.accuracy.dt_s = 1.0 / 240;
  ScriptedRun run(scene,
                  [](const ScriptedPhysics&, int) { return std::vector<SpeculativeContact>{}; });
  int frames = 0;
  while (const FramePtr frame = run.simulation.next()) {
    EXPECT_NEAR(frame->time_s, frames / 60.0, 1e-12);
    EXPECT_NEAR(frame->bodies[0].X_WB.position.x(), frames / 60.0, 1e-9);
    ++frames;
  }
  EXPECT_EQ(frames, 31);
}

TEST(Simulation, FiresShotsAtTheirTimeAndCountsTheirMassFromTheStart) {
  Scene scene = scene_of({}, {});
  scene.shots = {{0.1, ball_at(Vec3::Zero(), Vec3(1, 0, 0))}};
  scene.duration_s = 0.2;
  ScriptedRun run(scene,
                  [](const ScriptedPhysics&, int) { return std::vector<SpeculativeContact>{}; });
  const FramePtr first = run.simulation.next();
  EXPECT_TRUE(first->bodies.empty());
  FramePtr last = first;
  while (const FramePtr frame = run.simulation.next()) last = frame;
  EXPECT_EQ(last->bodies.size(), 1u);
  EXPECT_DOUBLE_EQ(first->report.mass_kg, last->report.mass_kg);
  EXPECT_NEAR(last->bodies[0].X_WB.position.x(), 0.1, 1.5 / 60);
}

TEST(Simulation, NamesTheSolidAndTheFormerBodyOfEachPiece) {
  const Solid front{"front", two_boxes(Vec3::Zero(), false), {}};
  Scene scene = scene_of({front}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))});
  scene.shots = {{0.02, ball_at(Vec3(0, 9, 0), Vec3(1, 0, 0))}};
  scene.shots[0].ball.name = "";
  ScriptedRun run(scene, always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
  EXPECT_EQ(run.simulation.next()->bodies[0].previous_key, 0u);
  FramePtr frame = run.simulation.next();
  EXPECT_EQ(*frame->names, (std::vector<std::string>{"front", scene.balls[0].name, "shot.0"}));
  ASSERT_EQ(frame->bodies.size(), 3u) << "the ball, then pieces";
  EXPECT_EQ(frame->bodies[0].previous_key, 1u);
  EXPECT_EQ(frame->bodies[0].name, 1u);
  for (const std::size_t piece : {1, 2}) {
    EXPECT_EQ(frame->bodies[piece].previous_key, 0u);
    EXPECT_EQ(frame->bodies[piece].name, 0u);
  }
  frame = run.simulation.next();
  ASSERT_EQ(frame->bodies.size(), 4u);
  for (const FrameBody& body : frame->bodies) EXPECT_EQ(body.previous_key, body.key);
  EXPECT_EQ(frame->bodies[3].name, 2u) << "of the shot";
}

TEST(Simulation, MovesItsCameraAlongItsKeys) {
  Scene scene = scene_of({}, {});
  scene.view.target_W = {0, 1, 0};
  scene.view_keys = {{0, Vec3(0, 0, 10), {}, {}}, {0.1, Vec3(4, 0, 10), {}, 0.5}};
  ScriptedRun run(scene,
                  [](const ScriptedPhysics&, int) { return std::vector<SpeculativeContact>{}; });
  FramePtr frame;
  for (int i = 0; i <= 3; ++i) frame = run.simulation.next();
  EXPECT_NEAR(frame->view.eye_W.x(), 2, 1e-9) << "half-way";
  EXPECT_EQ(frame->view.target_W, Vec3(0, 1, 0));
  for (int i = 0; i < 6; ++i) frame = run.simulation.next();
  EXPECT_EQ(frame->view.fov_rad, 0.5);
}

TEST(Simulation, KeepsTheMeshesThatABreakDoesNotChange) {
  const Solid solid{"box", two_boxes(Vec3::Zero(), false), {}};
  ScriptedRun run(scene_of({solid}, {ball_at(Vec3(-0.3, 0.5, 0.5), Vec3(9, 0, 0))}),
                  always(1, 0, Vec3(0, 0.5, 0.5), Vec3(1, 0, 0)));
  const FramePtr before = run.simulation.next();
  const FramePtr after = run.simulation.next();
  ASSERT_EQ(after->breaks.size(), 1u);
  EXPECT_EQ(after->meshes->size(), before->meshes->size());
  EXPECT_EQ(after->instances.size(), before->instances.size());
}

TEST(PieceMesh, LeavesOutCoveredFaces) {
  Compound compound = two_boxes(Vec3::Zero(), false);
  const auto face_towards = [&](std::size_t c, const Vec3& normal) {
    const auto& faces = compound.convexes[c]->polyhedron.faces;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      if (faces[f].plane.normal.dot(normal) > 0.9) return f;
    }
    return 0u;
  };
  compound.bonds = {{0, 1, face_towards(0, Vec3::UnitX()), face_towards(1, -Vec3::UnitX()), 1}};
  const auto hidden = hidden_faces(compound);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(std::count(hidden[c].begin(), hidden[c].end(), 1), 1);
    EXPECT_EQ(make_mesh(*compound.convexes[c], hidden[c])->indices.size(), 5u * 6);
  }
}

TEST(PieceMesh, FacesOutwards) {
  const std::shared_ptr<const Mesh> ball = make_ball_mesh(2, MaterialIndex(0));
  const ConvexPtr box = make_convex(make_box(-Vec3::Ones(), Vec3::Ones()), MaterialIndex(0));
  const std::shared_ptr<const Mesh> cube = make_mesh(*box, std::vector<std::uint8_t>(6, 0));
  for (const Mesh* mesh : {ball.get(), cube.get()}) {
    for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
      const Vec3f a = mesh->vertices[mesh->indices[i]].position;
      const Vec3f b = mesh->vertices[mesh->indices[i + 1]].position;
      const Vec3f c = mesh->vertices[mesh->indices[i + 2]].position;
      EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0.f);
    }
  }
}

}  // namespace
}  // namespace sunder
