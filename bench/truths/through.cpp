// A steel ball of 20 m/s through what breaks: how fast it comes out, into how many pieces, and how
// deep anything overlaps on the way. Minutes, so in the bench only.
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

enum Figure { kSpeed, kPieces, kDepth, kFigures };
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
Measure off_the_mean(const Target& target, Figure figure) {
  return [=](const Preset& preset) {
    double mean = 0, scatter = 0;
    for (const Preset& other : kPresets) {
      mean += shots(target, other).mean[figure] / kPresets.size();
      scatter += shots(target, other).scatter[figure] / kPresets.size();
    }
    return (shots(target, preset).mean[figure] - mean) / std::max(0.1 * mean, 1.5 * scatter);
  };
}
Measure deepest_mm(const Target& target) {
  return [=](const Preset& preset) { return 1e3 * shots(target, preset).deepest_m; };
}

}  // namespace

Truths through_truths() {
  const char* same = "the same at every preset";
  const char* allowed = "of 10 % or 1.5 x scatter";
  return {
      truth(27, "ball through an anchored wall: exit speed", allowed, same, 1,
            off_the_mean(kAnchoredWall, kSpeed), {2.4, 1, 1.9, 1.6}, 0),
      truth(27, "ball through an anchored wall: pieces", allowed, same, 1,
            off_the_mean(kAnchoredWall, kPieces), {0.25, 0.37, 0.54, 0.66}, 0),
      truth(27, "ball through an anchored wall: deepest overlap", "mm", "rigid", 10,
            deepest_mm(kAnchoredWall), {310, 220, 110, 280}, 0),
      truth(27, "ball through a dry wall: exit speed", allowed, same, 1,
            off_the_mean(kDryWall, kSpeed), {1, 0.79, 0.36, 0.1}, 0),
      truth(27, "ball through a dry wall: pieces", allowed, same, 1,
            off_the_mean(kDryWall, kPieces), {2, 0.59, 1.9, 0.69}, 0),
      truth(27, "ball through a dry wall: deepest overlap", "mm", "rigid", 10, deepest_mm(kDryWall),
            {300, 170, 190, 49}, 0),
      truth(27, "ball through a slab: exit speed", allowed, same, 1, off_the_mean(kSlab, kSpeed),
            {1, 1, 0.86, 1.6}, 0),
      truth(27, "ball through a slab: pieces", allowed, same, 1, off_the_mean(kSlab, kPieces),
            {0.1, 0.39, 0.1, 0.52}, 0),
      truth(27, "ball through a slab: deepest overlap", "mm", "rigid", 10, deepest_mm(kSlab),
            {430, 120, 47, 28}, 0),
      truth(27, "ball through a pane: exit speed", allowed, same, 1, off_the_mean(kPane, kSpeed),
            {0.16, 0.28, 0.1, 0.2}, 0),
      truth(27, "ball through a pane: pieces", allowed, same, 1, off_the_mean(kPane, kPieces),
            {2, 0.69, 0.29, 0.97}, 0),
      truth(27, "ball through a pane: deepest overlap", "mm", "rigid", 10, deepest_mm(kPane),
            {150, 34, 51, 5.4}, 0),
  };
}

}  // namespace sunder::truths
