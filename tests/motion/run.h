// Small scenes with the real solver and breaker, for tests of destruction in motion.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "fracture/solids.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::tests {

inline constexpr MaterialIndex kBrittle{0}, kSteel{1};

/// Returns a scene without gravity and with the ground far away. Material 0 breaks into Voronoi
/// cells; material 1 never breaks.
inline Scene bare_scene(double dt_s, double toughness_J_m2, double density_kg_m3) {
  Scene scene;
  Material brittle;
  brittle.name = "brittle";
  brittle.density_kg_m3 = density_kg_m3;
  brittle.toughness_J_m2 = toughness_J_m2;
  brittle.pattern.kind = PatternSpec::Kind::kVoronoi;
  brittle.pattern.cells = 12;
  brittle.impact_radius_m = 0.5;
  brittle.smallest_break_m3 = 1e-3;  // most pieces do not break again
  brittle.friction = 0;
  Material steel;
  steel.name = "steel";
  steel.density_kg_m3 = 8000;
  steel.friction = 0;
  scene.materials = {brittle, steel};
  scene.gravity_W.setZero();
  scene.accuracy = {dt_s, 4};
  scene.ground.height_m = -1000;
  scene.duration_s = 100;
  return scene;
}

/// Returns a box with sides along the axes, of material 0 unless given.
inline Solid box_solid(const Vec3& center_W, const Vec3& size, std::uint8_t anchored = 0,
                       MaterialIndex material = kBrittle) {
  Compound box = fracture::box_compound(-0.5 * size, 0.5 * size, anchored);
  if (material.value != 0) {
    box.convexes[0] = make_convex(box.convexes[0]->polyhedron, material);
  }
  return {"box", std::move(box), {Vec3(center_W), Quat::Identity()}};
}

inline Ball steel_ball(double radius_m, const Vec3& center_W, const Vec3& velocity_W) {
  return {"ball", radius_m, kSteel, center_W, velocity_W};
}

/// Simulation, with the breaks of its frames so far.
struct Trial {
  std::unique_ptr<Simulation> simulation;
  FramePtr frame;
  double broken_J = 0;
  std::vector<BreakEvent> breaks;

  explicit Trial(Scene scene)
      : simulation(std::make_unique<Simulation>(scene,
                                                solver::make_rigid_physics({scene.gravity_W}),
                                                fracture::make_pattern_breaker())),
        frame(simulation->next()) {}

  void step() {
    frame = simulation->next();
    for (const BreakEvent& event : frame->breaks) broken_J += event.energy_J;
    breaks.insert(breaks.end(), frame->breaks.begin(), frame->breaks.end());
  }
  double kinetic_J() const { return frame->report.kinetic_J; }
  /// Steps until `done(body(key))`, or until the time `max_s`.
  void step_until(double max_s, const std::function<bool(const FrameBody&)>& done,
                  std::uint64_t key) {
    while (frame->time_s < max_s && !done(body(key))) step();
  }
  /// Returns the body of `key`, or an empty one if it is gone. Keys count solids first, then balls.
  const FrameBody& body(std::uint64_t key) const {
    for (const FrameBody& body : frame->bodies) {
      if (body.key == key) return body;
    }
    static const FrameBody gone;
    return gone;
  }
};

}  // namespace sunder::tests
