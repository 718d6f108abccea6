// Tests that a jointed body hits with the mass that is joined to it, at any time step.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/motion/decided.h"

namespace sunder::tests {
namespace {

class JoinedAtAnyStep : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, JoinedAtAnyStep, testing::Values(1.0 / 60, 1.0 / 240, 1.0 / 960));

constexpr double kSteel_kg_m3 = 8000;

/// Returns a steel sphere of `mass_kg`.
Ball ball_of(double mass_kg, const Vec3& center_W, const Vec3& velocity_W) {
  const double volume_m3 = mass_kg / kSteel_kg_m3;
  return steel_ball(std::cbrt(volume_m3 * 3 / (4 * std::numbers::pi)), center_W, velocity_W);
}

/// Returns a scene of a very light pane normal to x, with its face at x = 0.
Scene scene_of_pane(double dt_s, double toughness_J_m2 = 300) {
  Scene scene = bare_scene(dt_s, toughness_J_m2, 1e-3);
  scene.solids = {wall(0, Vec3(0.025, 0, 0), 1, 0.05)};
  return scene;
}

/// Relative tolerance of energies: a body on an arc hits at a slightly different point.
constexpr double kArcTolerance = 0.005;

Joint joint_of(JointKind kind, std::optional<std::uint32_t> a, std::optional<std::uint32_t> b,
               const Vec3& at_W, const Vec3& to_W = Vec3::Zero()) {
  Joint joint;
  joint.kind = kind;
  joint.a = a, joint.b = b;
  joint.at_W = at_W, joint.to_W = to_W;
  return joint;
}

TEST_P(JoinedAtAnyStep, ABallHitsWithTheMassOfTheBallFixedToIt) {
  for (const JointKind kind : {JointKind::kFixed, JointKind::kDistance}) {
    const auto scene_of = [&](double speed) {
      Scene scene = scene_of_pane(GetParam());
      const Vec3 velocity_W(speed, 0, 0);
      scene.balls = {ball_of(1, Vec3(-0.1, 0, 0), velocity_W),
                     ball_of(9, Vec3(-0.4, 0, 0), velocity_W)};
      scene.joints = {joint_of(kind, 1u, 2u, Vec3(-0.1, 0, 0), Vec3(-0.4, 0, 0))};
      return scene;
    };
    expect_decided_by_work(
        scene_of, [](double speed) { return kinetic_J(10, speed); }, true, kArcTolerance);
  }
}

TEST_P(JoinedAtAnyStep, APendulumHitsAtTheBottomWithTheMassOfItsBall) {
  for (const JointKind kind : {JointKind::kDistance, JointKind::kRope}) {
    const auto scene_of = [&](double speed) {
      Scene scene = scene_of_pane(GetParam());
      scene.balls = {ball_of(5, Vec3(-0.1, 0, 0), Vec3(speed, 0, 0))};
      scene.joints = {joint_of(kind, 1u, {}, Vec3(-0.1, 0, 0), Vec3(0, 8, 0))};
      scene.balls[0].velocity_W.y() = 0.1 / 8 * speed;  // tangential to its circle
      return scene;
    };
    expect_decided_by_work(
        scene_of, [](double speed) { return kinetic_J(5, speed); }, true, kArcTolerance);
  }
}

TEST_P(JoinedAtAnyStep, AChainMovingLengthwiseHitsWithAllOfItsMass) {
  constexpr int kLinks = 8;
  const auto scene_of = [&](double speed) {
    Scene scene = scene_of_pane(GetParam());
    for (int i = 0; i < kLinks; ++i) {
      const Vec3 center_W(-0.1 - 0.2 * i, 0, 0);
      scene.balls.push_back(ball_of(1, center_W, Vec3(speed, 0, 0)));
      if (i == 0) continue;
      const auto key = static_cast<std::uint32_t>(i);
      scene.joints.push_back(joint_of(JointKind::kBall, key, key + 1, center_W + Vec3(0.1, 0, 0)));
    }
    return scene;
  };
  expect_decided_by_work(
      scene_of, [](double speed) { return kinetic_J(kLinks, speed); }, true, kArcTolerance);
}

/// Returns a door in the plane z = 0, with its hinge along y at x = −1 and its free edge at x = 0.
Solid door(MaterialIndex material) {
  return box_solid(Vec3(-0.5, 0, 0), Vec3(1, 0.5, 0.05), 0, material);
}

/// Returns the moment of inertia of the door about its hinge, in kg m².
double door_kgm2(double density_kg_m3) {
  const double kg = density_kg_m3 * 1 * 0.5 * 0.05;
  return kg * (1.0 / 3 + 0.05 * 0.05 / 12);
}

TEST_P(JoinedAtAnyStep, ADoorHitsWithItsInertiaAboutTheHinge) {
  const auto scene_of = [&](double speed) {
    Scene scene = bare_scene(GetParam(), 300, 1e-3);
    scene.solids = {wall(2, Vec3(-0.1, 0, 0.1), 1, 0.05), door(kSteel)};
    scene.materials[0].smallest_break_m3 = 0.99 * volume(scene.solids[0].compound);
    scene.solids[1].velocity_W = Vec3(0, 0, 0.5 * speed);
    scene.solids[1].angular_velocity_W = Vec3(0, -speed, 0);
    Joint hinge = joint_of(JointKind::kHinge, 1u, {}, Vec3(-1, 0, 0));
    hinge.axis_W = Vec3::UnitY();
    scene.joints = {hinge};
    return scene;
  };
  // The remains of the pane stop the door afterwards, so the final energy is not checked.
  expect_decided_by_work(
      scene_of, [](double w) { return 0.5 * door_kgm2(8000) * w * w; }, false, kArcTolerance);
}

TEST_P(JoinedAtAnyStep, ADoorHitAtItsEdgeTakesTheWorkOfItsEffectiveMass) {
  const double arm_m = 0.97, ball = 100;
  const auto scene_of = [&](double speed) {
    Scene scene = bare_scene(GetParam(), 300, 500);
    scene.solids = {door(kBrittle)};
    scene.materials[0].smallest_break_m3 = 0.99 * volume(scene.solids[0].compound);
    const Ball like = ball_of(ball, Vec3::Zero(), Vec3::Zero());
    scene.balls = {ball_of(ball, Vec3(arm_m - 1, 0, -like.radius_m - 0.035), Vec3(0, 0, speed))};
    Joint hinge = joint_of(JointKind::kHinge, 0u, {}, Vec3(-1, 0, 0));
    hinge.axis_W = Vec3::UnitY();
    scene.joints = {hinge};
    return scene;
  };
  const double door_kg = door_kgm2(500) / (arm_m * arm_m);
  expect_decided_by_work(
      scene_of, [&](double speed) { return door_kg / (door_kg + ball) * kinetic_J(ball, speed); },
      false);
}

}  // namespace
}  // namespace sunder::tests
