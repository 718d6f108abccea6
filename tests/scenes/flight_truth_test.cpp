// What breaks in flight goes on as a whole: its centre on the parabola, linear and angular momentum
// kept through every break, at every preset (notes: truth 16).
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "scenes/load.h"
#include "solver/rigid/rigid_physics.h"
#include "bench/truths/forwarding_physics.h"

namespace sunder::tests {
namespace {

/// Mass and motion of all there is.
struct Whole {
  double mass_kg = 0;
  Vec3 moment_kgm = Vec3::Zero(), momentum_Ns = Vec3::Zero(), spin_Nms = Vec3::Zero();

  Vec3 center() const { return moment_kgm / mass_kg; }
  /// Angular momentum about the centre of all.
  Vec3 own_spin() const { return spin_Nms - center().cross(momentum_Ns); }
};

/// The rigid solver, with the masses of what is in it.
class WeighedPhysics final : public ForwardingPhysics {
 public:
  explicit WeighedPhysics(const solver::RigidOptions& options)
      : ForwardingPhysics(solver::make_rigid_physics(options)) {}

  std::vector<BodyId> replace(std::span<const BodyId> remove,
                              std::span<const BodyDesc> add) override {
    std::erase_if(bodies_, [&](const auto& body) {
      return std::find(remove.begin(), remove.end(), body.first) != remove.end();
    });
    const std::vector<BodyId> ids = physics_->replace(remove, add);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (!add[i].is_static) bodies_.emplace_back(ids[i], add[i]);
    return ids;
  }

  Whole whole() const {
    Whole sum;
    for (const auto& [id, desc] : bodies_) {
      const BodyState s = physics_->state(id);
      const Mat3 R = s.X_WB.rotation.toRotationMatrix();
      const Vec3 momentum = desc.mass_kg * s.velocity_W;
      sum.mass_kg += desc.mass_kg;
      sum.moment_kgm += desc.mass_kg * s.X_WB.position;
      sum.momentum_Ns += momentum;
      sum.spin_Nms += s.X_WB.position.cross(momentum) +
                      R * desc.inertia_B * R.transpose() * s.angular_velocity_W;
    }
    return sum;
  }
  std::size_t count() const { return bodies_.size(); }

 private:
  std::vector<std::pair<BodyId, BodyDesc>> bodies_;
};

constexpr const char* kScene = R"(
[scene]
description = "A block high above the ground, hit by a ball."
duration_s = 1.5
[limits]
debris = 0
parts_a_frame = 100000  # what waits for its turn is held where it is
dust = 0
[[material]]
name = "concrete"
smallest_piece_m3 = 0.0
[[solid]]
structure = "box"
size_m = [1, 2, 1]
position = [0, 500, 0]
velocity = [0, 5, 0]
angular_velocity = [0.5, 0, 1]
[[ball]]
position = [-2, 501.2, 0.2]
velocity = [40, 5, 0]
radius_m = 0.3
)";

TEST(FlightTruth, WhatBreaksInFlightKeepsItsMomentaAndItsParabola) {
  for (const char* preset : {"draft", "realtime", "accurate", "reference"}) {
    Scene scene = scenes::parse_scene(kScene, "flight.toml", {preset, {}});
    const Vec3 gravity = scene.gravity_W;
    auto owned = std::make_unique<WeighedPhysics>(solver::RigidOptions{});
    const WeighedPhysics* physics = owned.get();
    Simulation simulation(std::move(scene), std::move(owned), fracture::make_pattern_breaker());
    std::size_t breaks = 0;
    double way_error_m = 0, momentum_error = 0, spin_error = 0;
    const Whole start = (simulation.next(), physics->whole());
    const Vec3 velocity = start.momentum_Ns / start.mass_kg;
    double spins_Nms = 0;  // of the ball about the centre of all: what changes hands
    spins_Nms = start.own_spin().norm();
    while (const FramePtr frame = simulation.next()) {
      breaks += frame->breaks.size();
      const Whole now = physics->whole();
      const double t = frame->time_s;
      ASSERT_NEAR(now.mass_kg, start.mass_kg, 1e-9 * start.mass_kg);
      const Vec3 parabola = start.center() + t * velocity + 0.5 * t * t * gravity;
      way_error_m = std::max(way_error_m, (now.center() - parabola).norm());
      const Vec3 expected = start.momentum_Ns + t * start.mass_kg * gravity;
      momentum_error =
          std::max(momentum_error, (now.momentum_Ns - expected).norm() / start.momentum_Ns.norm());
      spin_error = std::max(spin_error, (now.own_spin() - start.own_spin()).norm() / spins_Nms);
    }
    std::printf(
        "fragments in flight, %-9s %zu breaks into %zu bodies: centre off by %.1e m, p %.1e "
        "(mark 1e-6), L %.1e (mark 1e-5)\n",
        preset, breaks, physics->count(), way_error_m, momentum_error, spin_error);
    EXPECT_GE(breaks, 1u);
    EXPECT_GT(physics->count(), 10u);
    // What misses its mark is held to what it reaches.
    EXPECT_LT(way_error_m, 1e-2);
    EXPECT_LT(momentum_error, 5e-6);
    EXPECT_LT(spin_error, 0.2);
  }
}

}  // namespace
}  // namespace sunder::tests
