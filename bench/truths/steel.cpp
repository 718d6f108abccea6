// Steel against the theory of plasticity: at which load it yields, what bending takes, what stays
// bent, and when it tears.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/truths/truth.h"
#include "scenes/file/make_compound.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

constexpr double kYield_Pa = 1e6, kWide = 0.2, kLong = 2, kDensity = 100;
constexpr double kBears_Nm = kYield_Pa * kWide * kWide * kWide / 4;
constexpr double kBears_N = kYield_Pa * kWide * kWide;
constexpr double kArm = kLong - 0.1, kGauge = 5.65 * kWide;
constexpr double kOwn_N = kDensity * kWide * kWide * kLong * kG;
constexpr MaterialIndex kSteel{0}, kHard{1};
constexpr std::uint32_t kBeam = 0, kLoad = 1;  // keys

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

/// A beam along x, so many blocks deep, held from x = 0 back.
Solid beam(int across) {
  std::vector<Part> parts;
  const double cell_m = kWide / across;
  add(Vec3(-cell_m, 0, 0), Vec3(0, kWide, kWide), cell_m, true, parts);
  add(Vec3::Zero(), Vec3(kLong, kWide, kWide), cell_m, false, parts);
  return {"beam", scenes::make_compound(std::move(parts)), {}};
}

struct Trial {
  int across = 2;
  double part = 1;  ///< Of the load that it bears.
  double hardening_Pa = 0, elongation = 0.2;
  double time_s = 2;
  bool pulled = false;  ///< Along the beam, in place of across.
};

/// A load on a rope at the tip, as a part of what theory allows.
Scene scene_of(const Preset& preset, const Trial& trial) {
  const double side_m = 0.2;
  const double force_N = trial.pulled ? trial.part * kBears_N - kOwn_N
                                      : (trial.part * kBears_Nm - 0.5 * kOwn_N * kLong) / kArm;
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
  const Vec3 tip(trial.pulled ? kLong : kArm, 0.5 * kWide, 0.5 * kWide);
  const Vec3 center = tip + 0.6 * scene.gravity_W.normalized(), half = Vec3::Constant(side_m / 2);
  scene.solids.push_back({"load",
                          scenes::make_compound({{make_box(-half, half), kHard}}),
                          {center, Quat::Identity()}});
  Joint rope;
  rope.kind = JointKind::kRope;
  rope.a = kBeam, rope.b = kLoad;
  rope.at_W = tip, rope.to_W = center;
  scene.joints = {rope};
  return scene;
}

/// How far the part with the tip has turned, be it a body of its own or not.
double bent_rad(const Frame& frame) {
  double most = 0;
  for (const Instance& instance : frame.instances) {
    const FrameBody& body = frame.bodies[instance.body];
    if (body.key == kLoad) continue;
    const Quat turned = body.X_WB.rotation * (*frame.meshes)[instance.mesh.value]->X_RT.rotation;
    most = std::max(most, 2 * std::asin(std::min(1.0, turned.vec().norm())));
  }
  return most;
}

/// Calls `look` with each frame until it says that it has seen enough.
template <class Look>
void watch(const Preset& preset, const Trial& trial, const Look& look) {
  const auto simulation = scenes::make_simulation(scene_of(preset, trial));
  while (const FramePtr frame = simulation->next())
    if (look(*frame)) return;
}

bool yields(const Preset& preset, const Trial& trial) {
  bool yields = false;
  const double some_J = 1e-3 * (trial.pulled ? kBears_N * kWide : kBears_Nm);
  watch(preset, trial,
        [&](const Frame& frame) { return yields = frame.report.plastic_J > some_J; });
  return yields;
}

Measure limit(Trial trial) {
  return [=](const Preset& preset) {
    return threshold(0.5, 1.5, 6,
                     [&](double part) {
                       Trial loaded = trial;
                       loaded.part = part;
                       return yields(preset, loaded);
                     }) -
           1;
  };
}
Measure limit(int across) { return limit(Trial{across}); }
Measure limit_pulled() {
  Trial trial;
  trial.pulled = true;
  return limit(trial);
}

/// What bending took, over M_p and the angle.
Measure work() {
  return [](const Preset& preset) {
    double work_J = 0, angle_rad = 0;
    watch(preset, {2, 1.3}, [&](const Frame& frame) {
      work_J = frame.report.plastic_J;
      angle_rad = bent_rad(frame);
      return false;
    });
    return angle_rad > 0.3 ? work_J / (kBears_Nm * angle_rad) - 1 : -1;
  };
}

/// By how much less it is bent at the end than it was at most.
Measure springs_back() {
  return [](const Preset& preset) {
    double most = 0, last = 0;
    watch(preset, {2, 1.1, 0, 0.2, 5}, [&](const Frame& frame) {
      last = bent_rad(frame);
      most = std::max(most, last);
      return false;
    });
    return most > 0.05 ? most - last : 1;
  };
}

/// How far it is bent when it tears, over where its outermost fibre is drawn out by its elongation.
Measure tears() {
  return [](const Preset& preset) {
    const Trial trial{2, 1.3, 0, 0.02};
    double angle_rad = 0;
    bool torn = false;
    watch(preset, trial, [&](const Frame& frame) {
      if (!(torn = !frame.breaks.empty())) angle_rad = bent_rad(frame);
      return torn;
    });
    return torn ? angle_rad / (trial.elongation * kGauge / (kWide / 2)) - 1 : 9;
  };
}

/// Drawn out by how much when it tears, over its elongation.
Measure tears_pulled() {
  return [](const Preset& preset) {
    const Trial trial{2, 1.1, 0, 0.2, 2, true};
    double first_m = 0, drawn_m = 0;
    bool torn = false;
    watch(preset, trial, [&](const Frame& frame) {
      const auto load = std::ranges::find(frame.bodies, kLoad, &FrameBody::key);
      const double at_m = load->X_WB.position.x();
      if (frame.index == 0) first_m = at_m;
      if (!(torn = !frame.breaks.empty())) drawn_m = at_m - first_m;
      return torn;
    });
    return torn ? drawn_m / (trial.elongation * kGauge) - 1 : 9;
  };
}

/// A bar 5 m long in the air, struck in its middle by a ball: a hinge forms there, both halves are
/// struck at their ends (a quarter of their mass), and what is left, when all moves as one, has
/// gone into bending.
Measure struck_in_the_air() {
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
    const double bends_J =
        0.5 * kSpeed_m_s * kSpeed_m_s * (shared_kg(bar_kg) - shared_kg(bar_kg / 4));
    return work_J / bends_J - 1;
  };
}

}  // namespace

Truths steel_truths() {
  const char* hinge = "M = σ b h²/4";
  return {
      truth(38, "steel cantilever of 1 block: yields", "", hinge, 0.1, limit(1),
            {0.036, 0.1, 0.1, 0.1}),
      truth(38, "steel cantilever of 2 blocks: yields", "", hinge, 0.1, limit(2),
            {0.059, 0.1, 0.1, 0.1}),
      truth(38, "steel cantilever of 4 blocks: yields", "", hinge, 0.1, limit(4),
            {0.059, 0.1, 0.1, 0.1}),
      truth(38, "steel bar pulled: yields", "", "N = σ A", 0.1, limit_pulled(),
            {0.1, 0.1, 0.1, 0.1}),
      truth(38, "steel cantilever: work of bending", "", "M θ", 0.05, work(),
            {0.005, 0.015, 0.006, 0.002}),
      truth(38, "steel cantilever: springs back", "rad", "rigid-plastic", 1e-3, springs_back(),
            {1e-6, 1e-6, 1e-6, 1e-6}),
      truth(38, "steel cantilever: tears when bent by", "", "ε = θ h/2 / 5.65 √A", 0.2, tears(),
            {0.05, 0.05, 0.05, 0.08}),
      truth(38, "steel bar: tears when drawn out by", "", "ε = Δ / 5.65 √A", 0.2, tears_pulled(),
            {0.06, 0.02, 0.01, 0.05}),
      truth(38, "steel bar struck in the air: work of bending", "", "momentum, two halves", 0.1,
            struck_in_the_air(), {0.64, 0.5, 0.15, 0.1}),
  };
}

}  // namespace sunder::truths
