// Tests of check_scene(): an invalid scene is refused with a message that names the member.
#include "engine/model/checks/scene_check.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/check.h"

namespace sunder {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Scene good() {
  Scene scene;
  scene.materials.resize(2);
  Solid solid;
  solid.compound.convexes = {make_convex(make_box(Vec3::Zero(), Vec3::Ones()), MaterialIndex(0))};
  solid.compound.anchored = {0};
  scene.solids = {solid, solid};
  scene.balls.resize(1);
  scene.balls[0].material = MaterialIndex(1);
  scene.joints.resize(1);
  scene.joints[0].a = 0;
  scene.joints[0].b = 1;
  scene.shots.resize(2);
  for (Shot& shot : scene.shots) shot.ball.material = MaterialIndex(1);
  scene.shots[0].time_s = 1;
  scene.shots[1].time_s = 2;
  scene.removals.resize(1);
  scene.removals[0].roots = {0, 2};
  return scene;
}

TEST(SceneCheck, AcceptsAValidScene) { EXPECT_NO_THROW(check_scene(good())); }

TEST(SceneCheck, NamesWhatIsWrong) {
  const std::pair<const char*, std::function<void(Scene&)>> mistakes[] = {
      {"solids[0] has material 0", [](Scene& s) { s.materials.clear(); }},
      {"gravity_W", [](Scene& s) { s.gravity_W.y() = kNaN; }},
      {"duration_s", [](Scene& s) { s.duration_s = -1; }},
      {"dt_s is 0;", [](Scene& s) { s.accuracy.dt_s = 0; }},
      {"1/120", [](Scene& s) { s.accuracy.dt_s = 0.01; }},
      {"dt_s", [](Scene& s) { s.accuracy.dt_s = kNaN; }},
      {"substeps", [](Scene& s) { s.accuracy.substeps = 0; }},
      {"sweeps", [](Scene& s) { s.solver.sweeps = -1; }},
      {"materials[1].density_kg_m3", [](Scene& s) { s.materials[1].density_kg_m3 = 0; }},
      {"materials[1].friction", [](Scene& s) { s.materials[1].friction = kNaN; }},
      {"materials[1].restitution", [](Scene& s) { s.materials[1].restitution = 2; }},
      {"materials[0].toughness_J_m2", [](Scene& s) { s.materials[0].toughness_J_m2 = -1; }},
      {"solids[1].compound has no convexes",
       [](Scene& s) { s.solids[1].compound.convexes.clear(); }},
      {"null convex", [](Scene& s) { s.solids[1].compound.convexes[0] = nullptr; }},
      {"anchored has 2",
       [](Scene& s) {
         s.solids[1].compound.anchored = {0, 0};
       }},
      {"solids[1].velocity_W has the element",
       [](Scene& s) { s.solids[1].velocity_W.x() = 100001; }},
      {"solids[1].angular_velocity_W has the element",
       [](Scene& s) { s.solids[1].angular_velocity_W.y() = -1.1e6; }},
      {"balls[0].velocity_W has the element", [](Scene& s) { s.balls[0].velocity_W.z() = 1.1e5; }},
      {"X_WR.position", [](Scene& s) { s.solids[1].X_WR.position.x() = kNaN; }},
      {"X_WR.rotation", [](Scene& s) { s.solids[1].X_WR.rotation.coeffs().setZero(); }},
      {"velocity_W", [](Scene& s) { s.solids[0].velocity_W.z() = kNaN; }},
      {"balls[0].radius_m", [](Scene& s) { s.balls[0].radius_m = 0; }},
      {"shots[1].ball has no material", [](Scene& s) { s.shots[1].ball.material = {}; }},
      {"balls[0] has material 7", [](Scene& s) { s.balls[0].material = MaterialIndex(7); }},
      {"joints[0] has no body", [](Scene& s) { s.joints[0].a = s.joints[0].b = std::nullopt; }},
      {"joints[0] has body 3", [](Scene& s) { s.joints[0].b = 3; }},
      {"joins a body to itself", [](Scene& s) { s.joints[0].b = 0; }},
      {"shots[1] comes before shots[0]", [](Scene& s) { s.shots[1].time_s = 0; }},
      {"shots[0].time_s", [](Scene& s) { s.shots[0].time_s = kNaN; }},
      {"removals[0].roots has index 3",
       [](Scene& s) {
         s.removals[0].roots = {0, 3};
       }},
      {"roots are not in ascending order",
       [](Scene& s) {
         s.removals[0].roots = {2, 0};
       }},
      {"materials[0].impact_radius_m is 0; expected a number from 0.001 to inf",
       [](Scene& s) { s.materials[0].impact_radius_m = 0; }},
      {"materials[0].stronger[0].impact_radius_m is 1e-300",
       [](Scene& s) {
         s.materials[0].stronger.resize(1);
         s.materials[0].stronger[0].impact_radius_m = 1e-300;
       }},
      {"materials[0].elongation is 0", [](Scene& s) { s.materials[0].elongation = 0; }},
      {"materials[0].pattern.spokes is 2", [](Scene& s) { s.materials[0].pattern.spokes = 2; }},
      {"materials[0].pattern.cells is 31 along each side of a grid; expected a number from 2 to 30",
       [](Scene& s) {
         s.materials[0].pattern.kind = PatternSpec::Kind::kGrid;
         s.materials[0].pattern.cells = 31;
       }},
      {"balls[0].center_W has the element 1e+10",
       [](Scene& s) { s.balls[0].center_W.x() = 1e10; }},
      {"limits.cluster_bodies is 0", [](Scene& s) { s.limits.cluster_bodies = 0; }},
      {"materials[0].pattern.cells",
       [](Scene& s) { s.materials[0].pattern.cells = -1; }},
      {"materials[0].pattern.file",
       [](Scene& s) { s.materials[0].pattern.kind = PatternSpec::Kind::kFile; }},
      {"materials[0].stronger[1].energy_J",
       [](Scene& s) {
         s.materials[0].stronger.resize(2);
         s.materials[0].stronger[0].energy_J = 10;
       }},
      {"materials[1].crumbling.debris_largest_m",
       [](Scene& s) { s.materials[1].crumbling.debris_largest_m = 0; }},
      {"limits.bodies is 0", [](Scene& s) { s.limits.bodies = 0; }},
      {"limits.piece_size_factor is -1", [](Scene& s) { s.limits.piece_size_factor = -1; }},
      {"limits.piece_size_factor is nan", [](Scene& s) { s.limits.piece_size_factor = kNaN; }},
      {"limits.piece_size_factor is 50, so that all pieces of the largest solid would be debris; "
       "expected at most 10",
       [](Scene& s) {
         s.limits.piece_size_factor = 50;
         s.materials[0].smallest_piece_m3 = 1e-3;
         s.materials[0].pattern.kind = PatternSpec::Kind::kVoronoi;
       }},
      {"limits.chip_size_factor is 0.5", [](Scene& s) { s.limits.chip_size_factor = 0.5; }},
      {"max_colors", [](Scene& s) { s.solver.max_colors = 65; }},
      {"solids[1].compound has a bond with a face",
       [](Scene& s) {
         Compound& compound = s.solids[1].compound;
         compound.convexes.push_back(compound.convexes[0]);
         compound.anchored.push_back(0);
         compound.bonds = {{0, 1, 0, 6, 1}};
       }},
      {"a ghost with convex 3",
       [](Scene& s) {
         Compound& compound = s.solids[1].compound;
         compound.ghosts = {{compound.convexes[0], {0, 3}}};
       }},
      {"joints[0].breaking_N", [](Scene& s) { s.joints[0].breaking_N = -1; }},
      {"joints[0].axis_W is zero",
       [](Scene& s) {
         s.joints[0].kind = JointKind::kHinge;
         s.joints[0].axis_W.setZero();
       }},
      {"blasts[0].radius_m",
       [](Scene& s) {
         s.blasts.resize(1);
         s.blasts[0].radius_m = 0;
       }},
      {"blasts[0].tnt_kg",
       [](Scene& s) {
         s.blasts.resize(1);
         s.blasts[0].tnt_kg = kNaN;
       }},
      {"shots[0].hangs_from_W",
       [](Scene& s) { s.shots[0].hangs_from_W = Vec3(0, kNaN, 0); }},
      {"removals[0] removes nothing", [](Scene& s) { s.removals[0].roots.clear(); }},
      {"removals[0] removes nothing",
       [](Scene& s) {
         s.removals[0].roots.clear();
         s.removals[0].anchors_W = {Vec3(-1, -1, -1), Vec3(2, 2, 2)};  // no convex is anchored
       }},
      {"drives[0] has no velocity", [](Scene& s) { s.drives.resize(1); }},
      {"drives[0].until_s",
       [](Scene& s) {
         s.drives.resize(1);
         s.drives[0].velocity_W = Vec3::Zero();
         s.drives[0].until_s = -1;
       }},
      {"moves[0].roots has index 2",
       [](Scene& s) {
         s.moves.resize(1);
         s.moves[0].roots = {2};
       }},
      {"moves[0].path has a key at 1",
       [](Scene& s) {
         s.moves.resize(1);
         s.moves[0].path.keys.resize(2);
         s.moves[0].path.keys[0].time_s = 2;
         s.moves[0].path.keys[1].time_s = 1;
       }},
      {"vertex 5", [](Scene& s) {
         s.ground.meshes.resize(1);
         s.ground.meshes[0].material = MaterialIndex(0);
         s.ground.meshes[0].vertices_W.resize(3, Vec3::Zero());
         s.ground.meshes[0].triangles = {{0, 1, 5}};
       }}};
  for (const auto& [name, spoil] : mistakes) {
    Scene scene = good();
    spoil(scene);
    try {
      check_scene(scene);
      ADD_FAILURE() << name << ": accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos)
          << name << ": " << error.what();
    }
  }
}

TEST(SceneCheck, InvalidBoxesAndPrismsAreRefused) {
  EXPECT_THROW(make_box(Vec3::Ones(), Vec3::Zero()), InputError);
  EXPECT_THROW(make_box(Vec3::Zero(), Vec3(1, kNaN, 1)), InputError);
  const Vec2 corners[] = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
  EXPECT_THROW(make_prism(std::span(corners, 2), 0, 1, false), InputError);
  EXPECT_THROW(make_prism(corners, 1, 0, false), InputError);
}

}  // namespace
}  // namespace sunder
