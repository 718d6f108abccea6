// Tests of the particle stage: emissions of breaks, and particles in frames.
#include <algorithm>

#include <gtest/gtest.h>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/polygon_mesh.h"
#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

/// Records the emissions and obstacles it gets; has one piece of debris after each advance.
class RecordingParticles final : public Particles {
 public:
  std::unique_ptr<Particles> copy() const override {
    return std::make_unique<RecordingParticles>(*this);
  }
  struct Face {
    std::vector<Vec3> corners_W;
    ExposedPolygon emission;
  };
  void emit(std::span<const ExposedPolygon> emitted) override {
    for (const ExposedPolygon& face : emitted) {
      faces.push_back({{face.corners_W.begin(), face.corners_W.end()}, face});
    }
  }
  void emit(std::span<const DebrisPiece> emitted) override {
    chips.insert(chips.end(), emitted.begin(), emitted.end());
  }
  void advance(double dt_s, const Obstacles& obstacles) override {
    steps_s.push_back(dt_s);
    bodies.assign(obstacles.bodies.begin(), obstacles.bodies.end());
    shapes = obstacles.shapes.size();
    ground_m = obstacles.ground_m;
    position.assign(1, Vec3f(1, 2, 3));
  }
  DebrisView debris() const override {
    if (position.empty()) return {};
    return {position, rotation, radius, variant, material};
  }
  DustView dust() const override { return {}; }
  ParticleReport report() const override {
    ParticleReport report;
    report.debris.alive = static_cast<std::uint32_t>(faces.size() + chips.size());
    report.debris.ignored = ignored;
    return report;
  }

  std::vector<Face> faces;
  std::vector<DebrisPiece> chips;
  std::vector<double> steps_s;
  std::vector<ObstacleBody> bodies;
  std::size_t shapes = 0;
  double ground_m = 0;
  std::uint64_t ignored = 0;
  std::vector<Vec3f> position;
  std::vector<Quatf> rotation{Quatf::Identity()};
  std::vector<float> radius{0.25f};
  std::vector<std::uint8_t> variant{3};
  std::vector<MaterialIndex> material{MaterialIndex(0)};
};

/// Returns a unit box with a visual mesh half as wide in z, whose face at the lowest x is a cap.
ConvexPtr box_with_a_half_cap(const Vec3& min) {
  ConvexPolyhedron polyhedron = make_box(min, min + Vec3::Ones());
  auto visual = std::make_shared<PolygonMesh>(polygon_mesh(make_box(min, min + Vec3(1, 1, 0.5))));
  polyhedron.faces[0].id = {2};
  const Vec3 out = polyhedron.faces[0].plane.normal;
  const auto cap = std::find_if(visual->faces.begin(), visual->faces.end(),
                                [&](const auto& face) { return face.plane.normal == out; });
  cap->id = {2};
  std::rotate(cap, cap + 1, visual->faces.end());
  return make_convex(std::move(polyhedron), MaterialIndex(0), std::move(visual));
}

/// Physics in which a ball touches a body after `delay_steps` steps, and in which the first solve
/// adds `change_m_s` to the velocity of every body.
class PushingPhysics final : public ScriptedPhysics {
 public:
  explicit PushingPhysics(const Vec3& change_m_s, int delay_steps = 0)
      : ScriptedPhysics([delay_steps](const ScriptedPhysics& physics, int collides) {
          if (collides < delay_steps) return std::vector<SpeculativeContact>{};
          return physics.approach(1, 0, Vec3(0, 0.5, 0.5), Vec3::UnitX());
        }),
        change_m_s_(change_m_s) {}

  SolveReport solve(double dt_s, int substeps) override {
    for (Body& body : bodies) body.state.velocity_W += change_m_s_;
    change_m_s_.setZero();
    return ScriptedPhysics::solve(dt_s, substeps);
  }

 private:
  Vec3 change_m_s_;
};

/// Simulation of two unit boxes of stone, one solid, that move along z, and of a ball that
/// separates them after `delay_steps` steps.
struct ParticleRun {
  explicit ParticleRun(double dt_s, double smallest_piece_m3 = 0, double particles_per_m2 = 10,
                       bool visual = false, const Vec3& change_m_s = Vec3::Zero(),
                       int delay_steps = 0, const Vec3& spin_rad_s = Vec3::Zero()) {
    Material stone;
    stone.density_kg_m3 = 1000;
    stone.pattern.kind = PatternSpec::Kind::kVoronoi;
    stone.smallest_piece_m3 = smallest_piece_m3;
    stone.smallest_break_m3 = 0;  // pieces that become chips break, too
    stone.crumbling.particles_per_m2 = particles_per_m2;
    Material steel;
    Scene scene;
    scene.materials = {stone, steel};
    scene.gravity_W = Vec3::Zero();
    scene.ground.height_m = -7;
    scene.accuracy = {dt_s, 1};
    Solid solid;
    for (int i = 0; i < 2; ++i) {
      const Vec3 min(i, 0, 0);
      solid.compound.convexes.push_back(
          visual ? box_with_a_half_cap(min)
                 : make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
      solid.compound.anchored.push_back(0);
    }
    solid.velocity_W = Vec3(0, 0, 2);
    solid.angular_velocity_W = spin_rad_s;
    scene.solids = {solid};
    scene.balls = {{"ball", 0.25, MaterialIndex(1), Vec3(-0.3, 0.5, 0.5), Vec3(60, 0, 2)}};
    auto owned = std::make_unique<RecordingParticles>();
    particles = owned.get();
    simulation = std::make_unique<Simulation>(
        std::move(scene), std::make_unique<PushingPhysics>(change_m_s, delay_steps),
        std::make_unique<ScriptedBreaker>(1.0), std::move(owned));
    simulation->next();
  }
  RecordingParticles* particles;
  std::unique_ptr<Simulation> simulation;
};

TEST(ParticleStage, EmitsFromEveryFaceThatABreakExposes) {
  ParticleRun run(1.0 / 60);
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->breaks.size(), 1u);
  ASSERT_EQ(run.particles->faces.size(), 2u);
  const ConvexPolyhedron box = make_box(Vec3::Zero(), Vec3::Ones());
  const RecordingParticles::Face& face = run.particles->faces[0];
  ASSERT_EQ(face.corners_W.size(), 4u);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_LT((face.corners_W[c] - box.vertices[box.face_corners(0)[c]]).norm(), 1e-12);
  }
  EXPECT_LT((face.emission.normal_W - box.faces[0].plane.normal).norm(), 1e-12);
  EXPECT_EQ(face.emission.material, MaterialIndex(0));
  EXPECT_EQ(face.emission.crumbling.particles_per_m2, 10);
  EXPECT_NEAR(face.emission.motion(face.corners_W[0]).z(), 2, 1e-9);
}

TEST(ParticleStage, FacesMoveWithTheirPiecesAfterTheImpactSeparatesThem) {
  ParticleRun run(1.0 / 60, 0, 10, false, Vec3(0, 3, 4));
  run.simulation->next();
  ASSERT_EQ(run.particles->faces.size(), 2u);
  const ConvexPolyhedron box = make_box(Vec3::Zero(), Vec3::Ones());
  for (const RecordingParticles::Face& face : run.particles->faces) {
    const Vec3 velocity_W = face.emission.motion(face.corners_W[0]);
    EXPECT_LT((velocity_W - Vec3(0, 3, 6)).norm(), 1e-9)
        << "the velocity of the parent plus the change by the impact";
    EXPECT_NEAR(face.emission.opening_speed_m_s, 5, 1e-9);
  }
  const Vec3 corner = box.vertices[box.face_corners(0)[0]];
  EXPECT_LT((run.particles->faces[0].corners_W[0] - corner).norm(), 1e-9)
      << "faces start at their place at the beginning of the frame";
}

TEST(ParticleStage, PiecesThatKeepTheSpinOfTheirSolidHaveNoSeparationSpeed) {
  // No impact has pushed the pieces: the break takes no energy and applies no impulse.
  ParticleRun run(1.0 / 60, 0, 10, false, Vec3::Zero(), 3, Vec3(2, 0, 0));
  for (int i = 0; i < 4; ++i) run.simulation->next();
  ASSERT_EQ(run.particles->faces.size(), 2u);
  for (const RecordingParticles::Face& face : run.particles->faces) {
    EXPECT_GT((face.emission.motion(face.corners_W[0]) - Vec3(0, 0, 2)).norm(), 0.1);
    EXPECT_LT(face.emission.opening_speed_m_s, 1e-9);
  }
}

TEST(ParticleStage, FacesOfASpinningSolidStartAtItsPoseWhenTheFrameBegan) {
  // The solid turns about ten times in a frame: a face moved in a straight line would be far away.
  ParticleRun run(1.0 / 60, 0, 10, false, Vec3::Zero(), 3, Vec3(3700, 0, 0));
  for (int i = 0; i < 4; ++i) run.simulation->next();
  ASSERT_EQ(run.particles->faces.size(), 2u);
  for (const RecordingParticles::Face& face : run.particles->faces) {
    const Vec3 normal_W =
        (face.corners_W[1] - face.corners_W[0]).cross(face.corners_W[2] - face.corners_W[0]);
    EXPECT_NEAR(normal_W.norm(), 1, 1e-9) << "a square, as before";
    EXPECT_LT((normal_W - face.emission.normal_W).norm(), 1e-9);
    for (const Vec3& corner_W : face.corners_W)
      EXPECT_LT((face.emission.motion(corner_W) - Vec3(0, 0, 2)).norm(), 3700 * 1.2);
  }
}

TEST(ParticleStage, AVisualMeshEmitsFromItsCaps) {
  ParticleRun run(1.0 / 60, 0, 10, true);
  run.simulation->next();
  ASSERT_EQ(run.particles->faces.size(), 4u) << "two triangles a cap";
  double area_m2 = 0;
  for (const RecordingParticles::Face& face : run.particles->faces) {
    ASSERT_EQ(face.corners_W.size(), 3u);
    const Vec3 a = face.corners_W[1] - face.corners_W[0], b = face.corners_W[2] - face.corners_W[0];
    area_m2 += 0.5 * a.cross(b).dot(face.emission.normal_W);
  }
  EXPECT_NEAR(area_m2, 2 * 0.5, 1e-9);
}

TEST(ParticleStage, AdvancesOnceAFrameFromItsBeginning) {
  ParticleRun run(1.0 / 240);
  run.simulation->next();
  ASSERT_EQ(run.particles->steps_s.size(), 1u);
  EXPECT_NEAR(run.particles->steps_s[0], 1.0 / 60, 1e-12);
  ASSERT_FALSE(run.particles->faces.empty());
  const ConvexPolyhedron box = make_box(Vec3::Zero(), Vec3::Ones());
  const Vec3 corner = box.vertices[box.face_corners(0)[0]];
  EXPECT_NEAR(run.particles->faces[0].corners_W[0].z(), corner.z(), 1e-9)
      << "the place at the beginning of the frame, whichever step broke the solid";
}

TEST(ParticleStage, GetsEveryBodyAndTheGroundAsObstacles) {
  ParticleRun run(1.0 / 60);
  run.simulation->next();
  ASSERT_EQ(run.particles->bodies.size(), 3u) << "the ball and two pieces";
  EXPECT_EQ(run.particles->shapes, 3u);
  EXPECT_EQ(run.particles->ground_m, -7);
  EXPECT_LT(run.particles->bodies[0].key, run.particles->bodies[1].key);
  EXPECT_TRUE(run.particles->bodies[1].moves);
}

TEST(ParticleStage, PiecesTooSmallForBodiesBecomeChipsAndTheirMassStays) {
  ParticleRun run(1.0 / 60, 1.5);
  const FramePtr frame = run.simulation->next();
  ASSERT_EQ(run.particles->chips.size(), 2u);
  const DebrisPiece& chip = run.particles->chips[0];
  EXPECT_LT((chip.center_W - Vec3(0.5, 0.5, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(4.0 / 3 * 3.14159265358979 * std::pow(chip.radius_m, 3), 1, 1e-9);
  EXPECT_NEAR(chip.velocity_W.z(), 2, 1e-9);
  EXPECT_EQ(frame->bodies.size(), 1u);
  ParticleRun bodies(1.0 / 60);
  EXPECT_NEAR(frame->report.mass_kg, bodies.simulation->next()->report.mass_kg, 1e-9);
}

/// Simulation of two unit boxes of stone that move along z, separated by a blast beside them.
struct BlastRun {
  explicit BlastRun(double smallest_piece_m3) {
    Material stone;
    stone.density_kg_m3 = 1000;
    stone.pattern.kind = PatternSpec::Kind::kVoronoi;
    stone.smallest_piece_m3 = smallest_piece_m3;
    stone.smallest_break_m3 = 0;
    stone.crumbling.particles_per_m2 = 10;
    Scene scene;
    scene.materials = {stone};
    scene.gravity_W = Vec3::Zero();
    scene.accuracy = {1.0 / 120, 1};
    Solid solid;
    for (int i = 0; i < 2; ++i) {
      const Vec3 min(2 + i, -0.5, -0.5);
      solid.compound.convexes.push_back(
          make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
      solid.compound.anchored.push_back(0);
    }
    solid.velocity_W = Vec3(0, 0, 1);
    scene.solids = {solid};
    scene.blasts = {{0, Vec3::Zero(), 4, 12000}};
    auto owned = std::make_unique<RecordingParticles>();
    particles = owned.get();
    simulation = std::make_unique<Simulation>(
        std::move(scene), std::make_unique<ScriptedPhysics>([](const auto&, int) {
          return std::vector<SpeculativeContact>{};
        }),
        std::make_unique<ScriptedBreaker>(1.0), std::move(owned));
    for (int i = 0; i < 6; ++i) simulation->next();
  }
  RecordingParticles* particles;
  std::unique_ptr<Simulation> simulation;
};

TEST(ParticleStage, FacesThatABlastExposesMoveWithTheirPieces) {
  BlastRun run(0);
  ASSERT_EQ(run.particles->faces.size(), 2u);
  for (const RecordingParticles::Face& face : run.particles->faces) {
    EXPECT_GT(face.emission.opening_speed_m_s, 0.5);
    EXPECT_GT(face.emission.motion(face.corners_W[0]).x(), 0.5);
  }
}

TEST(ParticleStage, ABlastPushesChipsThatItMakes) {
  BlastRun run(1.5);
  ASSERT_EQ(run.particles->chips.size(), 2u);
  const DebrisPiece& chip = run.particles->chips[0];
  EXPECT_GT(chip.velocity_W.x(), 0.5);
  EXPECT_NEAR(chip.velocity_W.z(), 1, 0.1);
  EXPECT_NEAR(chip.center_W.z(), 0.05, 1e-9) << "the chip has moved for three steps";
}

TEST(ParticleStage, AChipOfAnyStepStartsWhereItWasWhenTheFrameBegan) {
  ParticleRun run(1.0 / 240, 1.5, 10, false, Vec3::Zero(), 2);
  run.simulation->next();
  ASSERT_EQ(run.particles->chips.size(), 2u);
  EXPECT_LT((run.particles->chips[0].center_W - Vec3(0.5, 0.5, 0.5)).norm(), 1e-9);
}

TEST(ParticleStage, WithNothingToMoveDoesNothing) {
  ParticleRun run(1.0 / 60, 0, 0);
  ASSERT_EQ(run.simulation->next()->breaks.size(), 1u) << "this material emits no particles";
  EXPECT_TRUE(run.particles->faces.empty());
  EXPECT_TRUE(run.particles->steps_s.empty());
}

TEST(ParticleStage, AFrameShowsParticlesAndCountsThoseOverTheLimit) {
  ParticleRun run(1.0 / 60);
  FramePtr frame = run.simulation->next();
  ASSERT_EQ(frame->debris.size(), 1u);
  EXPECT_EQ(frame->debris[0].position_W, Vec3f(1, 2, 3));
  EXPECT_EQ(frame->debris[0].variant, 3);
  EXPECT_EQ(frame->report.counts.debris, 1u);
  EXPECT_EQ(frame->report.limits_hit, 0u);
  run.particles->ignored = 5;
  frame = run.simulation->next();
  EXPECT_EQ(frame->report.limits_hit, 1u);
  EXPECT_EQ(frame->report.limits[Limit::kDebris], 1u);
  EXPECT_EQ(run.simulation->next()->report.limits_hit, 0u);
}

}  // namespace
}  // namespace sunder
