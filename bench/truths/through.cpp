// A steel ball of 20 m/s through what breaks: how fast it comes out, into how many pieces, and how
// deep anything overlaps on the way.
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
  const char* solid;  ///< About x = 0, its front near z = 0.
  double radius_m;    ///< Of the ball, which arrives 1.5 m above the ground.
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
                             0.3};
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

/// One shot, aimed a little otherwise for every seed.
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

/// Of eight seeds.
struct Shots {
  Figures mean{}, scatter{};
  double deepest_m = 0;
};
const Shots& shots(const Target& target, const Preset& preset) {
  static std::map<std::pair<std::string, std::string>, Shots> known;
  const auto [place, is_new] = known.try_emplace({target.name, preset.name});
  if (!is_new) return place->second;
  Shots& all = place->second;
  constexpr int kSeeds = 8;
  Figures square{};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Figures one = shoot(target, preset, seed);
    for (std::size_t i = 0; i < kFigures; ++i) {
      all.mean[i] += one[i] / kSeeds;
      square[i] += one[i] * one[i] / kSeeds;
    }
    all.deepest_m = std::max(all.deepest_m, one[kDepth]);
  }
  for (std::size_t i = 0; i < kFigures; ++i)
    all.scatter[i] = std::sqrt(std::max(0.0, square[i] - all.mean[i] * all.mean[i]));
  return all;
}

/// How far a preset is off the mean of all, over 10 % of that or, if that is more, 1.5 times the
/// scatter of the seeds.
Measure off_the_mean(const Target& target, ShotFigure figure) {
  return [=](const Preset& preset) {
    double mean = 0, scatter = 0;
    for (const Preset& other : kPresets) {
      mean += shots(target, other).mean[figure] / kPresets.size();
      scatter += shots(target, other).scatter[figure] / kPresets.size();
    }
    return (shots(target, preset).mean[figure] - mean) / std::max(0.1 * mean, 1.5 * scatter);
  };
}
/// One step of a ball that strikes 300 packed boxes at 20 m/s and weighs as much as all of them.
struct Impact {
  double handed_on_m_s = 0;  ///< Speed that the ball lost.
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
    const double bond = 0.5 * (layer % 2);  // every other layer is half a box further
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
double impact_handed_on(const Preset& preset) {
  constexpr int kConverged = 256;
  return impact(preset, preset.sweeps).handed_on_m_s / impact(preset, kConverged).handed_on_m_s - 1;
}
double impact_overlaps_mm(const Preset& preset) {
  return 1e3 * impact(preset, preset.sweeps).deepest_m;
}

Measure deepest_mm(const Target& target) {
  return [=](const Preset& preset) { return 1e3 * shots(target, preset).deepest_m; };
}

}  // namespace

Truths through_truths() {
  const char* same = "the same at every preset";
  const char* allowed = "of 10 % or 1.5 x scatter";
  return {
      truth(27, "ball into 300 packed boxes: what a step hands on", "", "256 sweeps", 0.1,
            impact_handed_on, {0.18, 0.23, 0.19, 0.11}),
      truth(27, "ball into 300 packed boxes: deepest overlap", "mm", "rigid", 30,
            impact_overlaps_mm, {7.7, 28, 9.2, 11}),
      truth(27, "ball through an anchored wall: pieces", allowed, same, 1,
            off_the_mean(kAnchoredWall, kPieces), {1, 1, 1.6, 1}),
      truth(27, "ball through an anchored wall: deepest overlap", "mm", "rigid", 10,
            deepest_mm(kAnchoredWall), {140, 120, 20, 30}),
      truth(27, "ball through a dry wall: exit speed", allowed, same, 1,
            off_the_mean(kDryWall, kSpeed), {1, 1, 1, 1}),
      truth(27, "ball through a dry wall: pieces", allowed, same, 1,
            off_the_mean(kDryWall, kPieces), {1, 1, 1, 1}),
      truth(27, "ball through a dry wall: deepest overlap", "mm", "rigid", 10, deepest_mm(kDryWall),
            {130, 160, 68, 22}),
      truth(27, "ball through a slab: exit speed", allowed, same, 1, off_the_mean(kSlab, kSpeed),
            {1, 1, 1, 1}),
      truth(27, "ball through a slab: pieces", allowed, same, 1, off_the_mean(kSlab, kPieces),
            {1, 1, 1, 1}),
      truth(27, "ball through a slab: deepest overlap", "mm", "rigid", 10, deepest_mm(kSlab),
            {75, 56, 46, 41}),
      truth(27, "ball through a pane: exit speed", allowed, same, 1, off_the_mean(kPane, kSpeed),
            {1, 1, 1, 1}),
      truth(27, "ball through a pane: pieces", allowed, same, 1, off_the_mean(kPane, kPieces),
            {1, 1.8, 1, 2.4}),
      truth(27, "ball through a pane: deepest overlap", "mm", "rigid", 10, deepest_mm(kPane),
            {61, 51, 24, 4.5}),
  };
}

}  // namespace sunder::truths
