// Extreme cases far from the origin, with slivers, and with a hundred thousand bodies.
#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/extremes/extreme.h"
#include "engine/base/cpu_time.h"
#include "engine/base/parallel.h"
#include "engine/io/state_hash.h"

namespace sunder::truths {
namespace {

constexpr double kDistance_m = 1e5;

std::string place(double x_m, double y_m, double z_m) {
  return "position = [" + std::to_string(x_m) + ", " + std::to_string(y_m) + ", " +
         std::to_string(z_m) + "]\n";
}
std::string stack(double x_m) {
  return "[[solid]]\nstructure = \"stack\"\nmaterial = \"steel\"\n" + place(x_m, 0, 0);
}
std::string wall_and_ball(double x_m) {
  return "[[solid]]\nstructure = \"box\"\nmaterial = \"brick\"\nsize_m = [3, 2, 0.1]\nblock_m = "
         "0.5\nanchored = \"bottom\"\n" +
         place(x_m, 0, 0) + "[[ball]]\nvelocity = [0, 0, -20]\nradius_m = 0.3\n" +
         place(x_m, 1.2, 2);
}

SceneAt at_distance(std::string (*text)(double), double duration_s) {
  return [=](const Preset& preset) { return scene_at(preset, text(kDistance_m), duration_s); };
}

/// Measures the relative difference of a result 1e5 m off from the result at the origin.
Measure relative_to_origin(std::string (*text)(double), double duration_s,
                           double (*figure)(const Run&)) {
  return [=](const Preset& preset) {
    const double here = mean_of_seeds(scene_at(preset, text(0), duration_s), figure);
    return mean_of_seeds(scene_at(preset, text(kDistance_m), duration_s), figure) / here - 1;
  };
}

double exit_speed(const Run& run) { return run.speed_m_s(1); }
double bodies(const Run& run) { return static_cast<double>(run.last->bodies.size()); }

Scene slivers(const Preset& preset) {
  std::string text = "[[material]]\nname = \"given\"\nlike = \"steel\"\n";
  for (int i = 0; i < 40; ++i)
    text += std::string("[[solid]]\nstructure = \"box\"\nmaterial = \"given\"\nsize_m = ") +
            (i % 2 == 0 ? "[1, 0.001, 0.001]" : "[1, 0.001, 0.5]") + "\nrotation_deg = [" +
            std::to_string(17 * i % 90) + ", " + std::to_string(29 * i % 90) + ", " +
            std::to_string(41 * i % 90) + "]\n" +
            place(0.1 * (i % 4), 1.2 + 0.1 * i, 0.1 * (i % 3));
  return scene_at(preset, text, 10);
}

/// Returns a pane of 1 m by 1 m by 1 mm that a ball breaks.
Scene thin_pane(const Preset& preset) {
  return scene_at(preset,
                  "[[solid]]\nstructure = \"pane\"\nwidth_m = 1\nheight_m = 1\nthickness_m = "
                  "0.001\n[[ball]]\nradius_m = 0.02\nposition = [0, 0.6, 1]\nvelocity = [0, 0, "
                  "-20]\n",
                  2, {"scene.gravity=[0, 0, 0]"});
}

double fastest(const Run& run) {
  double most = 0;
  for (const FrameBody& body : run.last->bodies) {
    const bool fell_through = !(body.X_WB.position.y() > -0.01);
    most = std::max(most, fell_through ? 1e3 : body.velocity_W.norm());
  }
  return most;
}

/// Returns `count` walls of a thousand bricks each, side by side.
SceneAt walls(int count) {
  return [count](const Preset& preset) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text +=
          "[[solid]]\nstructure = \"brick_wall\"\nmaterial = \"steel\"\nsecond = \"steel\"\n"
          "bricks = 50\ncourses = 20\nname = \"wall " +
          std::to_string(i) + "\"\n" + place(20.5 * (i % 10), 0, 2.0 * (i / 10));
    return scene_at(preset, text, 0.1, {"limits.bodies=200000"});
  };
}
constexpr int kManyWalls = 100, kFewerWalls = 10, kThreadTestWalls = 20;

/// Relative increase of processor time per body from 10,000 to 100,000 bricks.
double cost_increase(const Preset& preset) {
  const auto cpu_ms_a_body = [&](int count) {
    Scene scene = walls(count)(preset);
    const std::size_t bodies = scene.solids.size();
    const double start_ms = cpu_ms();
    run(std::move(scene));
    return (cpu_ms() - start_ms) / static_cast<double>(bodies);
  };
  const double of_fewer_ms = cpu_ms_a_body(kFewerWalls);
  return cpu_ms_a_body(kManyWalls) / of_fewer_ms - 1;
}

/// Number of runs (with 2 and 4 threads) whose final state differs from that with 1 thread.
double thread_differences(const Preset& preset) {
  const auto hash = [&](int threads) {
    set_threads(threads);
    return hash_state(*run(walls(kThreadTestWalls)(preset)).last);
  };
  const std::uint64_t one = hash(1);
  const double differ = double(hash(2) != one) + double(hash(4) != one);
  set_threads(0);
  return differ;
}

}  // namespace

Truths place_extremes() {
  return {
      extreme(9, "stack of 10, 1e5 m off, 5 s: moves", "mm", "rest", 2, at_distance(stack, 5),
              [](const Run& r) { return 1e3 * r.largest_displacement_m(); }, {0.2, 0.2, 0.2, 0.2}),
      extreme(9, "ball through a wall, 1e5 m off: exit speed", "", "that at the origin", 0.1,
              at_distance(wall_and_ball, 0.5), relative_to_origin(wall_and_ball, 0.5, exit_speed),
              {0.1, 0.019, 0.075, 0.04}),
      extreme(9, "ball through a wall, 1e5 m off: bodies", "", "those at the origin", 0.25,
              at_distance(wall_and_ball, 0.5), relative_to_origin(wall_and_ball, 0.5, bodies),
              {0.25, 0.025, 0.058, 0.06}),
      extreme(9, "ball through a wall, 1e5 m off: mass", "", "constant", 1e-9,
              at_distance(wall_and_ball, 1), &Run::mass_error, {1e-10, 1e-10, 1e-10, 1e-10}),
      extreme(10, "slivers of 1 : 1,000 after 10 s: fastest", "m/s", "rest", 0.1, slivers, fastest,
              {0.1, 0.1, 0.1, 0.075}),
      extreme(10, "slivers of 1 : 1,000: energy gained", "", "none", 1e-3, slivers,
              &Run::energy_gained, {0.0001, 0.00014, 0.00012, 0.0001}),
      extreme(10, "pane of 1 mm by 1 m, shot: mass", "", "constant", 1e-9, thin_pane,
              &Run::mass_error, {1e-10, 1e-10, 1e-10, 1e-10}),
      extreme(10, "pane of 1 mm by 1 m, shot: energy gained", "", "none", 1e-3, thin_pane,
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(11, "20,000 bricks in 20 walls, 0.1 s: moves", "mm", "rest", 2,
              walls(kThreadTestWalls),
              [](const Run& r) { return 1e3 * r.largest_displacement_m(); }, {0.2, 0.2, 0.2, 0.2}),
      extreme(11, "20,000 bricks, 2 and 4 threads: ends other than 1 thread's", "", "none", 0,
              walls(kThreadTestWalls), Measure(thread_differences), {0, 0, 0, 0}),
      timing(extreme(11, "100,000 bricks: processor time of each, over that of 10,000, less one",
                     "", "linear", 0.2, walls(kManyWalls), Measure(cost_increase),
                     {0.6, 0.3, 0.36, 0.27})),
  };
}

}  // namespace sunder::truths
