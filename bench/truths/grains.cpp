// Validation of granular motion: dominoes, collapsing columns of grains and heaps.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "bench/truths/truth.h"
#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"

namespace sunder::truths {
namespace {

/// Speed of the wave along a row of 30 dominoes of this height, divided by √(gH).
double domino_speed(const Preset& preset, double height_m) {
  PresetWorld world(preset);
  const double friction = 0.5, pitch_m = height_m / 2;
  world.add(W::with_friction(W::ground(), 1));
  std::vector<BodyId> dominoes;
  for (int i = 0; i < 30; ++i) {
    const Vec3 size = height_m * Vec3(0.125, 1, 0.5);
    dominoes.push_back(
        world.add(W::with_friction(W::box(size, Vec3(i * pitch_m, 0.5 * height_m, 0)), friction)));
  }
  const double mass_kg = 1000 * 0.0625 * std::pow(height_m, 3);
  world.physics().apply_impulse(dominoes[0], Vec3(0.3 * mass_kg * std::sqrt(kG * height_m), 0, 0),
                                Vec3(0, height_m, 0));
  const auto lean = [&](int i) {
    return (world.state(dominoes[static_cast<std::size_t>(i)]).X_WB.rotation * Vec3::UnitY()).x();
  };
  constexpr int kFirstTimed = 10, kLastTimed = 25;
  constexpr double kMinLean = 0.1;
  double time_s = 0, first_s = 0, last_s = 0, before_first = 0, before_last = 0;
  world.watch(40 * std::sqrt(height_m / kG), [&] {
    time_s += preset.dt_s;
    const auto find_crossing = [&](double now, double& before, double& passed_s) {
      if (passed_s == 0 && now > kMinLean)
        passed_s = time_s - preset.dt_s * (now - kMinLean) / (now - before);
      before = now;
    };
    find_crossing(lean(kFirstTimed), before_first, first_s);
    find_crossing(lean(kLastTimed), before_last, last_s);
  });
  return (kLastTimed - kFirstTimed) * pitch_m / (last_s - first_s) / std::sqrt(kG * height_m);
}

double domino_scales(const Preset& preset) {
  return domino_speed(preset, 0.1) / domino_speed(preset, 0.8) - 1;
}

/// Heap that results from a column of a thousand grains, 1.5 times as high as its radius.
struct Heap {
  double runout = 0;     ///< Radius of 98 % of the grains over the column's radius, less 1.
  double slope_deg = 0;  ///< Slope of its side.
};
constexpr double kRadius_m = 0.25, kAspect = 1.5;

/// Adds `count` grains of 6 cm above each other in a cylinder.
std::vector<BodyId> pour(PresetWorld& world, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<BodyId> grains;
  for (int i = 0; i < count; ++i) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 12; ++k) corners.push_back(0.03 * random.direction());
    const double turn = 2.4 * i;  // golden angle
    const Vec3 at(0.18 * std::sqrt((i % 20) / 20.0) * sin_cos(turn).cos, 0.05 + 0.07 * (i / 20),
                  0.18 * std::sqrt((i % 20) / 20.0) * sin_cos(turn).sin);
    grains.push_back(world.add(W::with_friction(W::hull(make_hull(corners), at, 2000), 0.6)));
  }
  return grains;
}

Heap collapse(const Preset& preset, std::uint64_t seed) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0.6));
  std::vector<BodyId> walls;
  for (int i = 0; i < 16; ++i) {
    const SinCos a = sin_cos(2 * kPi * i / 16);
    const Vec3 out(a.cos, 0, a.sin);
    BodyDesc wall = W::ground(-out);
    wall.X_WB.position = kRadius_m * out;
    walls.push_back(world.add(wall));
  }
  const std::vector<BodyId> grains = pour(world, 1400, seed);
  world.run(2.5);
  // Grains above the height of the column are removed.
  std::vector<BodyId> column;
  for (const BodyId id : grains) {
    if (world.state(id).X_WB.position.y() < kAspect * kRadius_m)
      column.push_back(id);
    else
      world.remove(id);
  }
  for (const BodyId id : walls) world.remove(id);
  world.run(2.5);
  std::vector<double> radii_m;
  double height_m = 0, radius_m = 0;
  for (const BodyId id : column) {
    const Vec3 at = world.state(id).X_WB.position;
    radii_m.push_back(std::hypot(at.x(), at.z()));
    radius_m += radii_m.back();
    height_m += at.y();
  }
  std::sort(radii_m.begin(), radii_m.end());
  const double edge_m = radii_m[radii_m.size() * 98 / 100];
  // The means of a cone are half its radius and a quarter of its height.
  return {edge_m / kRadius_m - 1, std::atan(2 * height_m / radius_m) * 180 / kPi};
}

/// Returns the mean of three heaps, as slopes of single ones scatter by a degree.
const Heap& heap(const Preset& preset) {
  constexpr int kHeaps = 3;
  static std::map<std::string, Heap> cache;
  const auto [place, is_new] = cache.try_emplace(preset.name);
  Heap& mean = place->second;
  for (int i = 0; is_new && i < kHeaps; ++i) {
    const Heap one = collapse(preset, 11 + static_cast<std::uint64_t>(i));
    mean.runout += one.runout / kHeaps;
    mean.slope_deg += one.slope_deg / kHeaps;
  }
  return mean;
}

double slope_off_mean_deg(const Preset& preset) {
  double mean = 0;
  for (const Preset& other : kPresets) mean += heap(other).slope_deg / kPresets.size();
  return heap(preset).slope_deg - mean;
}

}  // namespace

Truths grain_truths() {
  return {
      truth(17, "domino wave: v/√(gH) at H = .1 m against .8 m", "", "similarity", 0.01,
            domino_scales, {0.14, 0.075, 0.066, 0.01}),
      truth(19, "column of 1.5 that collapses: runout", "", "1.24 a, Lube et al. 2004", 0.15,
            [](const Preset& p) { return heap(p).runout / (1.24 * kAspect) - 1; },
            {0.44, 0.44, 0.43, 0.4}),
      truth(20, "the same: slope of the heap, off the mean of all presets", "°",
            "the same at every step", 1, slope_off_mean_deg, {1, 1, 1, 1}),
  };
}

}  // namespace sunder::truths
