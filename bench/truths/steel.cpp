// Validation of steel by the theory of plasticity: yield load, work, recovery and tearing.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/truths/truth.h"
#include "scenes/file/make_compound.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

constexpr double kYield_Pa = 1e6, kWidth_m = 0.2, kLength_m = 2, kDensity = 100;
constexpr double kPlasticMoment_Nm = kYield_Pa * kWidth_m * kWidth_m * kWidth_m / 4;
constexpr double kYieldForce_N = kYield_Pa * kWidth_m * kWidth_m;
constexpr double kLoadArm_m = kLength_m - 0.1, kGaugeLength_m = 5.65 * kWidth_m;
constexpr double kSelfWeight_N = kDensity * kWidth_m * kWidth_m * kLength_m * kG;
constexpr MaterialIndex kSteel{0}, kUnyielding{1};
constexpr std::uint32_t kBeam = 0, kLoad = 1;  // keys of bodies

void add(const Vec3& low, const Vec3& high, double cell_m, bool anchored,
         std::vector<Part>& parts) {
  const Vec3 size = high - low;
  const Eigen::Vector3i n = (size / cell_m).array().round().max(1).cast<int>();
  const Vec3 cell = size.cwiseQuotient(n.cast<double>());
  for (int i = 0; i < n.prod(); ++i) {
    const Vec3 corner =
        low + cell.cwiseProduct(Vec3(i % n.x(), i / n.x() % n.y(), i / (n.x() * n.y())));
    parts.push_back({make_box(corner, corner + cell), kSteel, anchored});
  }
}

/// Returns a beam along x, `across` blocks high, that is anchored at x < 0.
Solid beam(int across) {
  std::vector<Part> parts;
  const double cell_m = kWidth_m / across;
  add(Vec3(-cell_m, 0, 0), Vec3(0, kWidth_m, kWidth_m), cell_m, true, parts);
  add(Vec3::Zero(), Vec3(kLength_m, kWidth_m, kWidth_m), cell_m, false, parts);
  return {"beam", scenes::make_compound(std::move(parts)), {}};
}

struct Trial {
  int across = 2;
  double load_factor = 1;  ///< Load divided by the theoretical yield load.
  double hardening_Pa = 0, elongation = 0.2;
  double time_s = 2;
  bool pulled = false;  ///< True if the load pulls along the beam.
};

/// Returns a beam with a load on a rope at its tip.
Scene scene_of(const Preset& preset, const Trial& trial) {
  const double side_m = 0.2;
  const double force_N =
      trial.pulled
          ? trial.load_factor * kYieldForce_N - kSelfWeight_N
          : (trial.load_factor * kPlasticMoment_Nm - 0.5 * kSelfWeight_N * kLength_m) / kLoadArm_m;
  Scene scene;
  Material steel, hard;
  steel.name = "steel", hard.name = "hard";
  steel.density_kg_m3 = kDensity, hard.density_kg_m3 = force_N / kG / std::pow(side_m, 3);
  steel.youngs_Pa = 2e11, steel.yield_Pa = kYield_Pa;
  steel.hardening_Pa = trial.hardening_Pa, steel.elongation = trial.elongation;
  scene.materials = {steel, hard};
  scene.accuracy = {preset.dt_s, preset.substeps};
  scene.solver.sweeps = preset.sweeps;
  scene.ground.height_m = -1000;
  scene.limits.load_work_a_frame = 1000000000;
  scene.duration_s = trial.time_s;
  scene.solids = {beam(trial.across)};
  if (trial.pulled) scene.gravity_W = Vec3(kG, 0, 0);
  const Vec3 tip(trial.pulled ? kLength_m : kLoadArm_m, 0.5 * kWidth_m, 0.5 * kWidth_m);
  const Vec3 center = tip + 0.6 * scene.gravity_W.normalized(), half = Vec3::Constant(side_m / 2);
  scene.solids.push_back({"load",
                          scenes::make_compound({{make_box(-half, half), kUnyielding}}),
                          {center, Quat::Identity()}});
  Joint rope;
  rope.kind = JointKind::kRope;
  rope.a = kBeam, rope.b = kLoad;
  rope.at_W = tip, rope.to_W = center;
  scene.joints = {rope};
  return scene;
}

/// Returns the rotation of the part with the tip, whether or not it is a body of its own.
double tip_rotation_rad(const Frame& frame) {
  double most = 0;
  for (const Instance& instance : frame.instances) {
    const FrameBody& body = frame.bodies[instance.body];
    if (body.key == kLoad) continue;
    const Quat rotation = body.X_WB.rotation * (*frame.meshes)[instance.mesh.value]->X_RT.rotation;
    most = std::max(most, 2 * std::asin(std::min(1.0, rotation.vec().norm())));
  }
  return most;
}

/// Calls visit() with each frame until it returns true.
template <class Visit>
void watch(const Preset& preset, const Trial& trial, const Visit& visit) {
  const auto simulation = scenes::make_simulation(scene_of(preset, trial));
  while (const FramePtr frame = simulation->next())
    if (visit(*frame)) return;
}

bool yields(const Preset& preset, const Trial& trial) {
  bool yields = false;
  const double some_J = 1e-3 * (trial.pulled ? kYieldForce_N * kWidth_m : kPlasticMoment_Nm);
  watch(preset, trial,
        [&](const Frame& frame) { return yields = frame.report.plastic_J > some_J; });
  return yields;
}

Measure yield_load(Trial trial) {
  return [=](const Preset& preset) {
    return threshold(0.5, 1.5, 6,
                     [&](double load_factor) {
                       Trial loaded = trial;
                       loaded.load_factor = load_factor;
                       return yields(preset, loaded);
                     }) -
           1;
  };
}
Measure yield_load(int across) { return yield_load(Trial{across}); }
Measure yield_load_pulled() {
  Trial trial;
  trial.pulled = true;
  return yield_load(trial);
}

/// Work of bending, divided by the plastic moment and the angle, less 1.
Measure bending_work() {
  return [](const Preset& preset) {
    double work_J = 0, angle_rad = 0;
    watch(preset, {2, 1.3}, [&](const Frame& frame) {
      work_J = frame.report.plastic_J;
      angle_rad = tip_rotation_rad(frame);
      return false;
    });
    return angle_rad > 0.3 ? work_J / (kPlasticMoment_Nm * angle_rad) - 1 : -1;
  };
}

/// Largest rotation less the rotation at the end; 1 if the beam did not bend enough.
Measure elastic_recovery() {
  return [](const Preset& preset) {
    double most = 0, last = 0;
    watch(preset, {2, 1.1, 0, 0.2, 5}, [&](const Frame& frame) {
      last = tip_rotation_rad(frame);
      most = std::max(most, last);
      return false;
    });
    return most > 0.05 ? most - last : 1;
  };
}

/// Relative error of the rotation at which the outermost fibre reaches the elongation and tears.
Measure tearing_rotation() {
  return [](const Preset& preset) {
    const Trial trial{2, 1.3, 0, 0.02};
    double angle_rad = 0;
    bool torn = false;
    watch(preset, trial, [&](const Frame& frame) {
      if (!(torn = !frame.breaks.empty())) angle_rad = tip_rotation_rad(frame);
      return torn;
    });
    return torn ? angle_rad / (trial.elongation * kGaugeLength_m / (kWidth_m / 2)) - 1 : 9;
  };
}

/// Extension at tearing, divided by that at the elongation, less 1.
Measure tearing_extension() {
  return [](const Preset& preset) {
    const Trial trial{2, 1.1, 0, 0.2, 2, true};
    double first_m = 0, extension_m = 0;
    bool torn = false;
    watch(preset, trial, [&](const Frame& frame) {
      const auto load = std::ranges::find(frame.bodies, kLoad, &FrameBody::key);
      const double at_m = load->X_WB.position.x();
      if (frame.index == 0) first_m = at_m;
      if (!(torn = !frame.breaks.empty())) extension_m = at_m - first_m;
      return torn;
    });
    return torn ? extension_m / (trial.elongation * kGaugeLength_m) - 1 : 9;
  };
}

/// A free bar of 5 m that a ball hits in the middle. In theory a hinge forms there, each half acts
/// on the ball with a quarter of its mass, and the energy that is lost until all parts move as one
/// is the work of bending.
Measure free_bar_work() {
  return [](const Preset& preset) {
    constexpr double kBar_m = 5, kSpeed_m_s = 20, kRadius_m = 0.35, kSteel_kg_m3 = 7800;
    Scene scene;
    Material steel;
    steel.density_kg_m3 = kSteel_kg_m3, steel.youngs_Pa = 2e11;
    steel.yield_Pa = 2.5e8, steel.elongation = 2;
    scene.materials = {steel};
    scene.accuracy = {preset.dt_s, preset.substeps};
    scene.solver.sweeps = preset.sweeps;
    scene.gravity_W.setZero();
    scene.ground.height_m = -1000;
    scene.limits.load_work_a_frame = 1000000000;
    scene.duration_s = 0.5;
    std::vector<Part> parts;
    const Vec3 half(kBar_m / 2, 0.05, 0.1);
    add(-half, half, 0.1, false, parts);
    scene.solids = {{"bar", scenes::make_compound(std::move(parts)), {}}};
    Ball ball;
    ball.material = kSteel;
    ball.radius_m = kRadius_m;
    ball.center_W = Vec3(0, 0.5, 0);
    ball.velocity_W = Vec3(0, -kSpeed_m_s, 0);
    scene.balls = {ball};
    const auto simulation = scenes::make_simulation(std::move(scene));
    double work_J = 0;
    while (const FramePtr frame = simulation->next()) work_J = frame->report.plastic_J;
    const double ball_kg = kSteel_kg_m3 * 4 / 3 * kPi * std::pow(kRadius_m, 3);
    const double bar_kg = kSteel_kg_m3 * 8 * half.prod();
    const auto shared_kg = [&](double kg) { return ball_kg * kg / (ball_kg + kg); };
    const double theory_J =
        0.5 * kSpeed_m_s * kSpeed_m_s * (shared_kg(bar_kg) - shared_kg(bar_kg / 4));
    return work_J / theory_J - 1;
  };
}

}  // namespace

Truths steel_truths() {
  const char* hinge = "M = σ b h²/4";
  return {
      truth(38, "steel cantilever of 1 block: yields", "", hinge, 0.1, yield_load(1),
            {0.036, 0.1, 0.1, 0.1}),
      truth(38, "steel cantilever of 2 blocks: yields", "", hinge, 0.1, yield_load(2),
            {0.059, 0.1, 0.1, 0.1}),
      truth(38, "steel cantilever of 4 blocks: yields", "", hinge, 0.1, yield_load(4),
            {0.059, 0.1, 0.1, 0.1}),
      truth(38, "steel bar pulled: yields", "", "N = σ A", 0.1, yield_load_pulled(),
            {0.1, 0.1, 0.1, 0.1}),
      truth(38, "steel cantilever: work of bending", "", "M θ", 0.05, bending_work(),
            {0.005, 0.015, 0.006, 0.002}),
      truth(38, "steel cantilever: springs back", "rad", "rigid-plastic", 1e-3, elastic_recovery(),
            {1e-6, 1e-6, 1e-6, 1e-6}),
      truth(38, "steel cantilever: tears when bent by", "", "ε = θ h/2 / 5.65 √A", 0.2,
            tearing_rotation(), {0.05, 0.05, 0.05, 0.08}),
      truth(38, "steel bar: tears when drawn out by", "", "ε = Δ / 5.65 √A", 0.2,
            tearing_extension(), {0.06, 0.02, 0.01, 0.05}),
      truth(38, "steel bar struck in the air: work of bending", "", "momentum, two halves", 0.1,
            free_bar_work(), {0.46, 0.45, 0.1, 0.1}),
  };
}

}  // namespace sunder::truths
