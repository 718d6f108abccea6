// Validation of breaks: conservation of momentum, angular momentum and energy.
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "bench/truths/truth.h"
#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/fixtures/forwarding_physics.h"

namespace sunder::truths {
namespace {

/// Mass, momentum and kinetic energy of all dynamic bodies.
struct MassAndMotion {
  double mass_kg = 0, kinetic_J = 0;
  Vec3 moment_kgm = Vec3::Zero(), momentum_Ns = Vec3::Zero(), angular_momentum_Nms = Vec3::Zero();

  Vec3 center() const { return moment_kgm / mass_kg; }
  /// Returns the angular momentum about the centre of mass.
  Vec3 angular_momentum_about_center() const {
    return angular_momentum_Nms - center().cross(momentum_Ns);
  }
};

/// Rigid physics that sums mass and motion of its dynamic bodies.
class SummingPhysics final : public ForwardingPhysics {
 public:
  using ForwardingPhysics::ForwardingPhysics;

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
  MassAndMotion sum_motion() const {
    MassAndMotion sum;
    for (const auto& [id, desc] : bodies_) {
      const BodyState s = physics_->state(id);
      const Mat3 R = s.X_WB.rotation.toRotationMatrix();
      const Vec3 momentum = desc.mass_kg * s.velocity_W;
      const Vec3 spin = R * desc.inertia_B * R.transpose() * s.angular_velocity_W;
      sum.mass_kg += desc.mass_kg;
      sum.kinetic_J += 0.5 * (momentum.dot(s.velocity_W) + spin.dot(s.angular_velocity_W));
      sum.moment_kgm += desc.mass_kg * s.X_WB.position;
      sum.momentum_Ns += momentum;
      sum.angular_momentum_Nms += s.X_WB.position.cross(momentum) + spin;
    }
    return sum;
  }

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
smallest_piece_m3 = 0.0  # nothing becomes debris
compressive_Pa = 2e8     # nor breaks again and again
tensile_Pa = 2e8
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

/// Largest errors of a flight during which a body breaks.
struct Flight {
  double center_m = 0, momentum = 0, spin = 0;
  double gain = 0;  ///< Energy created, divided by the kinetic energy at the start.
  std::size_t breaks = 0;
};

Flight fly(const Preset& preset) {
  Scene scene = scenes::parse_scene(kScene, "flight.toml", {preset.name, {}});
  const Vec3 gravity_W = scene.gravity_W;
  solver::RigidOptions options;
  options.gravity_W = gravity_W;
  options.sweeps = scene.solver.sweeps;
  auto owned = std::make_unique<SummingPhysics>(solver::make_rigid_physics(options));
  const SummingPhysics& physics = *owned;
  Simulation simulation(std::move(scene), std::move(owned), fracture::make_pattern_breaker());
  simulation.next();
  const MassAndMotion start = physics.sum_motion();
  const auto energy = [&](const MassAndMotion& whole) {
    return whole.kinetic_J - gravity_W.dot(whole.moment_kgm - start.moment_kgm);
  };
  Flight worst;
  double allowed_J = energy(start);
  while (const FramePtr frame = simulation.next()) {
    const MassAndMotion now = physics.sum_motion();
    const double t = frame->time_s;
    for (const BreakEvent& event : frame->breaks) allowed_J -= event.energy_J;
    worst.breaks += frame->breaks.size();
    worst.gain = std::max(worst.gain, (energy(now) - allowed_J) / start.kinetic_J);
    allowed_J = std::min(allowed_J, energy(now));
    const Vec3 parabola =
        start.center() + t / start.mass_kg * start.momentum_Ns + 0.5 * t * t * gravity_W;
    const Vec3 expected = start.momentum_Ns + t * start.mass_kg * gravity_W;
    worst.center_m = std::max(worst.center_m, (now.center() - parabola).norm());
    worst.momentum =
        std::max(worst.momentum, (now.momentum_Ns - expected).norm() / start.momentum_Ns.norm());
    worst.spin = std::max(
        worst.spin,
        (now.angular_momentum_about_center() - start.angular_momentum_about_center()).norm() /
            start.angular_momentum_about_center().norm());
  }
  return worst;
}

/// Measures an error of the flight; 1e9 if nothing broke.
Measure flight_error(double Flight::*which) {
  return [=](const Preset& p) {
    const Flight flight = fly(p);
    return flight.breaks > 0 ? flight.*which : 1e9;
  };
}

struct Block {
  const char* size;
  double mass_kg;
};
constexpr Block kPlate = {"size_m = [2, 0.1, 2]\nblock_m = 0.5\n", 960};
constexpr Block kCube = {"size_m = [0.5, 0.5, 0.5]\n", 300};

/// Returns the energy of the first break of a block that lands flat at that speed; 0 if it holds.
/// `phase` shifts the landing within a step by a fraction of a frame.
double break_energy_J(const Block& block, const Preset& preset, double speed_m_s, double phase) {
  const double start_m_s = phase * kG / 60;
  const double above_m = (speed_m_s * speed_m_s - start_m_s * start_m_s) / (2 * kG);
  const std::string text =
      "[scene]\ndescription = \"A landing.\"\nduration_s = 0.4\n[limits]\ndebris = 0\ndust = 0\n"
      "[[material]]\nname = \"concrete\"\ntoughness_J_m2 = 400\n"
      "tensile_Pa = 0\nshear_Pa = 0\ncompressive_Pa = 0\n"  // no break by bending when it rocks
      "[[solid]]\nstructure = \"box\"\nmaterial = \"concrete\"\nposition = [0, " +
      std::to_string(above_m) + ", 0]\nvelocity = [0, " + std::to_string(-start_m_s) + ", 0]\n" +
      block.size;
  const auto simulation =
      scenes::make_simulation(scenes::parse_scene(text, "landing.toml", {preset.name, {}}));
  while (const FramePtr frame = simulation->next())
    if (!frame->breaks.empty()) return frame->breaks.front().energy_J;
  return 0;
}

/// Relative error of the speed whose kinetic energy is the crack energy; the worst of three phases.
Measure breaking_speed_error(const Block& block) {
  return [=](const Preset& preset) {
    double worst = 0;
    for (const double phase : {0.0, 1 / 3.0, 2 / 3.0}) {
      const auto breaks = [&](double v) { return break_energy_J(block, preset, v, phase) > 0; };
      const double speed = threshold(0.2, 3, 12, breaks);
      const double crack_J = break_energy_J(block, preset, 1.001 * speed, phase);
      const double error = speed / std::sqrt(2 * crack_J / block.mass_kg) - 1;
      if (!(std::abs(error) < std::abs(worst))) worst = error;
    }
    return worst;
  };
}

}  // namespace

Truths break_truths() {
  return {
      truth(16, "block broken in flight: its centre", "m", "parabola", 1e-4,
            flight_error(&Flight::center_m), {5e-5, 3.5e-5, 9.2e-05, 9e-5}),
      truth(16, "block broken in flight: p", "", "constant but for gravity", 1e-6,
            flight_error(&Flight::momentum), {1.7e-06, 1e-06, 1.9e-06, 4e-06}),
      truth(16, "block broken in flight: L", "", "constant", 1e-5, flight_error(&Flight::spin),
            {8e-05, 2.8e-04, 1.6e-04, 1.6e-05}),
      truth(26, "block broken in flight: energy beyond what breaks leave", "",
            "KE after ≤ before − toughness × area", 1e-6, flight_error(&Flight::gain),
            {1.9e-07, 1e-7, 1e-7, 2e-7}),
      truth(27, "plate that lands flat: speed that breaks it", "", "½mv² = toughness × area", 0.01,
            breaking_speed_error(kPlate), {0.001, 0.001, 0.001, 0.001}),
      truth(27, "cube that lands flat: speed that breaks it", "", "½mv² = toughness × area", 0.01,
            breaking_speed_error(kCube), {0.001, 0.001, 0.001, 0.001}),
  };
}

}  // namespace sunder::truths
