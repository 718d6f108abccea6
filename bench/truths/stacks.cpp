// Validation of stacks, towers and walls: they stand, do not sink, and load the ground.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"

namespace sunder::truths {
namespace {

/// Adds ground and a stack of boxes of 1 m; the top one is `top_factor` times as heavy.
std::vector<BodyId> add_stack(RigidWorld& world, int count, double top_factor = 1) {
  world.add(W::ground());
  std::vector<BodyId> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(world.add(
        W::box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0), i + 1 < count ? 1000 : 1000 * top_factor)));
  return boxes;
}

/// Largest displacement of a box in a stack of ten after ten seconds.
double displacement_of_ten_mm(const Preset& preset) {
  PresetWorld world(preset);
  const std::vector<BodyId> boxes = add_stack(world, 10);
  world.run(10);
  double worst_m = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 home(0, static_cast<double>(i) + 0.5, 0);
    worst_m = std::max(worst_m, (world.state(boxes[i]).X_WB.position - home).norm());
  }
  return 1e3 * worst_m;
}

double speed_of_ten(const Preset& preset) {
  PresetWorld world(preset);
  const std::vector<BodyId> boxes = add_stack(world, 10);
  world.run(10);
  double fastest = 0;
  for (const BodyId id : boxes) fastest = std::max(fastest, world.state(id).velocity_W.norm());
  return fastest;
}

double penetration_of_fifty(const Preset& preset) {
  PresetWorld world(preset);
  add_stack(world, 50);
  world.run(3);
  double deepest_m = 0;
  for (const float depth : world.physics().penetrations())
    deepest_m = std::max(deepest_m, static_cast<double>(depth));
  return deepest_m;
}

/// Time by which a tower of a hundred cubes falls before `duration_s`; 0 if it does not fall.
double missing_standing_s(const Preset& preset, double side_m, double duration_s, bool sleeping) {
  solver::RigidOptions options = solver::options_of(preset);
  options.sleeping = sleeping;
  RigidWorld world(options);
  world.add(W::ground());
  BodyId top;
  for (int i = 0; i < 100; ++i)
    top = world.add(W::box(Vec3::Constant(side_m), side_m * Vec3(0, i + 0.5, 0)));
  const auto steps = static_cast<int>(std::lround(duration_s / preset.dt_s));
  for (int i = 0; i < steps; ++i) {
    if (world.state(top).X_WB.position.y() < 98.5 * side_m) return duration_s - i * preset.dt_s;
    if (world.step(preset.dt_s, preset.substeps).awake == 0) break;
  }
  return 0;
}

/// Sinking of the top of ten boxes whose weights grow to a thousandfold, divided by its height.
double growing_weights_sink(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  BodyId last;
  double density = 1000;
  for (int i = 0; i < 10; ++i) {
    last = world.add(W::box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0), density));
    density *= 2.154434690031884;  // 1000 to the power of 1/9
  }
  world.run(20);
  return 1 - world.state(last).X_WB.position.y() / 9.5;
}

/// Adds twenty courses of bricks in a running bond, with half bricks at the ends of every other
/// one.
BodyId add_wall(RigidWorld& world) {
  const Vec3 whole(0.4, 0.2, 0.2), half(0.2, 0.2, 0.2);
  BodyId middle;
  for (int row = 0; row < 20; ++row) {
    const double y = 0.2 * row + 0.1, shift = row % 2 ? 0.2 : 0;
    for (int i = 0; i < 50 - row % 2; ++i) {
      const BodyId brick = world.add(W::box(whole, Vec3(0.4 * i + 0.2 + shift, y, 0), 2000));
      if (i == 24) middle = brick;
    }
    if (row % 2 == 0) continue;
    world.add(W::box(half, Vec3(0.1, y, 0), 2000));
    world.add(W::box(half, Vec3(19.9, y, 0), 2000));
  }
  return middle;
}

double wall_sink_mm(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  const BodyId top = add_wall(world);
  world.run(10);
  return 1e3 * (3.9 - world.state(top).X_WB.position.y());
}

double pyramid_rms_m_s(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  constexpr int kBase = 20;
  for (int row = 0; row < kBase; ++row)
    for (int i = 0; i < kBase - row; ++i)
      world.add(W::box(Vec3(1, 1, 1), Vec3((i + 0.5 * row) * 1.02, row + 0.5, 0), 2000));
  world.run(10);
  double square = 0;
  for (std::size_t i = 1; i < world.size(); ++i)
    square += world.state(world.id(i)).velocity_W.squaredNorm();
  return std::sqrt(square / static_cast<double>(world.size() - 1));
}

/// Impulse on the ground in one second below ten boxes with a heavy top, divided by that of their
/// weight, less 1; 1 if the stack falls.
double floor_load(const Preset& preset, double top_factor) {
  PresetWorld world(preset);
  const std::vector<BodyId> boxes = add_stack(world, 10, top_factor);
  const double weight_N = 1000 * (9 + top_factor) * kG;
  world.run(4);
  double ground_Ns = 0;
  const auto steps = static_cast<int>(std::lround(1 / preset.dt_s));
  for (int i = 0; i < steps; ++i)
    ground_Ns += world.step().external_impulse_Ns.y() + weight_N * preset.dt_s;
  const bool stands = world.state(boxes.back()).X_WB.position.y() > 9;
  return stands ? ground_Ns / weight_N - 1 : 1;
}

}  // namespace

Truths stack_truths() {
  const char* rigid = "rigid";
  return {
      truth(8, "stack of 10, 10 s: off its place", "mm", rigid, 2, displacement_of_ten_mm,
            {0.2, 0.2, 0.2, 0.2}),
      truth(8, "stack of 10, 10 s: speed", "m/s", rigid, 1e-3, speed_of_ten,
            {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(8, "stack of 50: deepest contact, of a side", "", rigid, 0.002, penetration_of_fifty,
            {0.0002, 0.0002, 0.0002, 0.0002}),
      truth(8, "wall of 1,010 bricks, 10 s: sinks", "mm", rigid, 2, wall_sink_mm,
            {0.2, 0.2, 0.2, 0.2}),
      truth(8, "pyramid of 210, 10 s: rms speed", "m/s", rigid, 1e-3, pyramid_rms_m_s,
            {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(9, "tower of 100 x 1 m, never asleep: falls before 20 s by", "s", rigid, 0,
            [](const Preset& p) { return missing_standing_s(p, 1, 20, false); }, {0, 1.1, 0, 0}),
      truth(9, "tower of 100 x 10 cm: falls before 120 s by", "s", rigid, 0,
            [](const Preset& p) { return missing_standing_s(p, 0.1, 120, true); },
            {120, 120, 0, 0}),
      truth(9, "tower of 100 x 10 cm, never asleep: falls before 20 s by", "s", rigid, 0,
            [](const Preset& p) { return missing_standing_s(p, 0.1, 20, false); },
            {20, 20, 18, 12}),
      truth(22, "stack of 10, weights growing to 1,000, 20 s: sinks, of its height", "", rigid,
            0.01, growing_weights_sink, {1, 1, 0.001, 0.001}),
      truth(22, "stack of 10 under a top of 100: load on the floor", "", "weight", 0.01,
            [](const Preset& p) { return floor_load(p, 100); }, {0.001, 0.001, 0.001, 0.001}),
      truth(22, "stack of 10 under a top of 1,000: load on the floor", "", "weight", 0.01,
            [](const Preset& p) { return floor_load(p, 1000); }, {1, 1, 0.001, 0.001}),
  };
}

}  // namespace sunder::truths
