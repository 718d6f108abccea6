// Validation of a steel ball of 20 m/s through breakable targets: exit speed, pieces, penetration.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "bench/truths/truth.h"
#include "engine/base/random.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

using solver::RigidOptions;
using W = solver::RigidWorld;

struct Target {
  const char* name;
  const char* solid;  ///< Centred at x = 0, with its front near z = 0.
  double radius_m;    ///< Radius of the ball, which hits 1.5 m above the ground.
  int seeds = 32;     ///< Number of shots.
};
constexpr Target kAnchoredWall = {"anchored wall", R"(
[[solid]]
structure = "box"
material = "brick"
size_m = [5, 3, 0.3]
block_m = 0.5
anchored = "bottom"
)",
                                  0.3};
constexpr Target kDryWall = {"dry wall", R"(
[[solid]]
structure = "brick_wall"
brick_m = [0.4, 0.2, 0.3]
bricks = 12
courses = 15
)",
                             0.3, 8};
constexpr Target kSlab = {"slab", R"(
[[solid]]
structure = "box"
material = "concrete"
size_m = [4, 3, 0.15]
anchored = "bottom"
)",
                          0.3};
constexpr Target kPane = {"pane", R"(
[[solid]]
structure = "pane"
width_m = 3
height_m = 2.6
)",
                          0.1};

enum ShotFigure { kSpeed, kPieces, kDepth, kFigures };
using Figures = std::array<double, kFigures>;

/// Simulates one shot; each seed aims at another point.
Figures shoot(const Target& target, const Preset& preset, std::uint64_t seed) {
  Random random(seed, 27);
  const double x = random.uniform(-0.2, 0.2), y = 1.5 + random.uniform(-0.2, 0.2);
  const std::string text =
      "[scene]\ndescription = \"A shot.\"\nduration_s = 1\nseed = " + std::to_string(seed) +
      "\n[limits]\ndust = 0\nparts_a_frame = 100000\n" + target.solid + "[[ball]]\nposition = [" +
      std::to_string(x) + ", " + std::to_string(y) +
      ", 1.5]\nvelocity = [0, 0, -20]\nradius_m = " + std::to_string(target.radius_m) + "\n";
  Scene scene = scenes::parse_scene(text, "shot.toml", {preset.name, {}});
  const std::size_t ball_key = scene.solids.size();
  const auto simulation = scenes::make_simulation(std::move(scene));
  Figures figures{};
  double first = 0;
  bool out = false;
  while (const FramePtr frame = simulation->next()) {
    if (frame->index == 0) first = static_cast<double>(frame->bodies.size());
    for (const FrameBody& body : frame->bodies) {
      if (body.key != ball_key || out) continue;
      figures[kSpeed] = body.velocity_W.norm();
      out = body.X_WB.position.z() < -1.5;
    }
    figures[kPieces] = static_cast<double>(frame->bodies.size()) - first;
    for (const float depth : frame->report.penetrations_m)
      figures[kDepth] = std::max(figures[kDepth], static_cast<double>(depth));
  }
  return figures;
}

/// Mean and standard deviation over the seeds of a target.
struct Shots {
  Figures mean{}, deviation{};
};
const Shots& shots(const Target& target, const Preset& preset) {
  static std::map<std::pair<std::string, std::string>, Shots> cache;
  const auto [place, is_new] = cache.try_emplace({target.name, preset.name});
  if (!is_new) return place->second;
  Shots& all = place->second;
  Figures square{};
  for (int seed = 1; seed <= target.seeds; ++seed) {
    const Figures one = shoot(target, preset, static_cast<std::uint64_t>(seed));
    for (std::size_t i = 0; i < kFigures; ++i) {
      all.mean[i] += one[i] / target.seeds;
      square[i] += one[i] * one[i] / target.seeds;
    }
  }
  for (std::size_t i = 0; i < kFigures; ++i)
    all.deviation[i] = std::sqrt(std::max(0.0, square[i] - all.mean[i] * all.mean[i]));
  return all;
}

/// Measures the deviation of a preset's mean from the mean of all presets, divided by the larger of
/// 10 % of that mean and 1.5 times the standard deviation of seeds.
Measure deviation_from_mean(const Target& target, ShotFigure figure) {
  return [=](const Preset& preset) {
    double mean = 0, deviation = 0;
    for (const Preset& other : kPresets) {
      mean += shots(target, other).mean[figure] / kPresets.size();
      deviation += shots(target, other).deviation[figure] / kPresets.size();
    }
    return (shots(target, preset).mean[figure] - mean) / std::max(0.1 * mean, 1.5 * deviation);
  };
}
/// One step of a ball that hits 300 packed boxes at 20 m/s; its mass is that of all boxes.
struct Impact {
  double transferred_m_s = 0;  ///< Speed that the ball lost.
  double deepest_m = 0;
};
Impact impact(const Preset& preset, int sweeps) {
  constexpr double kSide = 0.2, kSpeed_m_s = 20;
  constexpr int kRow = 10, kRows = 6, kLayers = 5, kBoxes = kRow * kRows * kLayers;
  RigidOptions options = solver::awake(Vec3::Zero());
  options.sweeps = sweeps;
  W world(options);
  for (int i = 0; i < kBoxes; ++i) {
    const int layer = i / (kRow * kRows);
    const double bond = 0.5 * (layer % 2);  // every other layer is shifted by half a box
    const Vec3 at(i % kRow - 4.5 + bond, i / kRow % kRows - 2.5 + bond, -layer - 0.5);
    world.add(W::with_friction(W::box(Vec3::Constant(kSide), kSide * at), 0.6));
  }
  BodyDesc ball = W::with_friction(W::sphere(0.3, Vec3(0.03, 0.02, 0.3001)), 0.6);
  const double scale = kBoxes * 1000 * kSide * kSide * kSide / ball.mass_kg;
  ball.mass_kg *= scale, ball.inertia_B *= scale;
  const BodyId id = world.add(W::moving(ball, Vec3(0, 0, -kSpeed_m_s)));
  world.step(preset.dt_s, preset.substeps);
  Impact all{kSpeed_m_s + world.state(id).velocity_W.z(), 0};
  for (const float depth : world.physics().penetrations())
    all.deepest_m = std::max(all.deepest_m, static_cast<double>(depth));
  return all;
}
double impact_transfer_error(const Preset& preset) {
  constexpr int kConverged = 256;
  return impact(preset, preset.sweeps).transferred_m_s /
             impact(preset, kConverged).transferred_m_s -
         1;
}
double impact_penetration_mm(const Preset& preset) {
  return 1e3 * impact(preset, preset.sweeps).deepest_m;
}

Measure deepest_mm(const Target& target) {
  return [=](const Preset& preset) { return 1e3 * shots(target, preset).mean[kDepth]; };
}

}  // namespace

Truths through_truths() {
  const char* same = "the same at every preset";
  const char* normalized = "of 10 % or 1.5 x scatter";
  return {
      truth(27, "ball into 300 packed boxes: what a step hands on", "", "256 sweeps", 0.1,
            impact_transfer_error, {0.1, 0.1, 0.1, 0.17}),
      truth(27, "ball into 300 packed boxes: deepest overlap", "mm", "rigid", 30,
            impact_penetration_mm, {7.7, 28, 16, 11}),
      truth(27, "ball through an anchored wall: pieces", normalized, same, 1,
            deviation_from_mean(kAnchoredWall, kPieces), {1, 1, 1, 1}),
      truth(27, "ball through an anchored wall: deepest overlap, mean of the shots", "mm", "rigid",
            10, deepest_mm(kAnchoredWall), {53, 41, 32, 10}),
      truth(27, "ball through a dry wall: exit speed", normalized, same, 1,
            deviation_from_mean(kDryWall, kSpeed), {1, 1, 1, 1}),
      truth(27, "ball through a dry wall: pieces", normalized, same, 1,
            deviation_from_mean(kDryWall, kPieces), {1, 1, 1, 1}),
      truth(27, "ball through a dry wall: deepest overlap, mean of the shots", "mm", "rigid", 10,
            deepest_mm(kDryWall), {62, 52, 37, 26}),
      truth(27, "ball through a slab: exit speed", normalized, same, 1,
            deviation_from_mean(kSlab, kSpeed), {1, 1, 1, 1}),
      truth(27, "ball through a slab: pieces", normalized, same, 1,
            deviation_from_mean(kSlab, kPieces), {1, 1, 1, 1}),
      truth(27, "ball through a slab: deepest overlap, mean of the shots", "mm", "rigid", 10,
            deepest_mm(kSlab), {52, 50, 32, 10}),
      truth(27, "ball through a pane: exit speed", normalized, same, 1,
            deviation_from_mean(kPane, kSpeed), {1, 1, 1, 1}),
      truth(27, "ball through a pane: pieces", normalized, same, 1,
            deviation_from_mean(kPane, kPieces), {1, 1, 1, 1}),
      truth(27, "ball through a pane: deepest overlap, mean of the shots", "mm", "rigid", 10,
            deepest_mm(kPane), {23, 16, 10, 10}),
  };
}

}  // namespace sunder::truths
