// The rigid solver on common benchmark scenes: rubble, wall, pyramid, stack, and thousands of
// touching cubes. Each row is followed by results of other engines (one thread, similar machine).
//
//   solver_bench piles [--scene NAME] [--threads N] [--substeps N] [--sweeps N] [--frames N]
//                      [--rate HZ] [--colors N] [--lanes N] [--seed N] [--sleep]
#include "bench/piles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/solver/solver_bench.h"
#include "engine/base/cpu_time.h"
#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "solver/rigid/rigid_physics.h"
#include "tests/fixtures/flags.h"

namespace sunder::solver {
namespace {

using bench::pyramid;
using bench::rubble;
using bench::stack;
using bench::touching_cubes;
using bench::wall;
using Set = bench::Pile;

struct Options {
  std::string scene = "all";
  int threads = 1;
  int substeps = 4;
  int sweeps = 1;
  int colors = 64;
  int lanes = 0;
  int frames = 0;  ///< 0: number of frames of the scene.
  double rate_Hz = 60;
  int seed = 1;  ///< Seed of the rubble.
  bool sleep = false;
};

struct Run {
  std::unique_ptr<Physics> physics;
  std::vector<BodyId> ids;
  std::vector<double> frame_ms;
  double add_ms = 0;
  SolveReport last;
};

void advance(Run& run, int frames, const Options& options) {
  const double dt = 1 / options.rate_Hz;
  const int steps = std::max(1, static_cast<int>(std::lround(options.rate_Hz / 60)));
  for (int frame = 0; frame < frames; ++frame) {
    const double start = cpu_ms();
    for (int step = 0; step < steps; ++step) {
      run.physics->collide(dt);
      run.last = run.physics->solve(dt, options.substeps);
    }
    run.frame_ms.push_back(cpu_ms() - start);
  }
}

Run begin(const Set& set, const Options& options) {
  RigidOptions rigid;
  rigid.sleeping = options.sleep;
  rigid.max_colors = options.colors;
  rigid.sweeps = options.sweeps;
  rigid.lanes = options.lanes;
  Run run;
  run.physics = make_rigid_physics(rigid);
  const double start = cpu_ms();
  run.ids = run.physics->replace({}, set.bodies);
  run.add_ms = cpu_ms() - start;
  return run;
}

void print(const char* name, const Run& run, const char* peers) {
  const std::vector<double>& ms = run.frame_ms;
  std::vector<double> sorted = ms;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0, last = 0, worst = 0;
  for (const double frame : ms) sum += frame, worst = std::max(worst, frame);
  const std::size_t tail = std::min<std::size_t>(60, ms.size());
  for (std::size_t i = ms.size() - tail; i < ms.size(); ++i) last += ms[i];
  std::vector<float> depths = run.physics->penetrations();
  std::sort(depths.begin(), depths.end());
  double depth = 0, square = 0;
  for (const float d : depths) depth += static_cast<double>(d);
  std::size_t moving = 0;
  std::uint64_t hash = 0;
  for (const BodyId id : run.ids) {
    const Vec3 v = run.physics->state(id).velocity_W;
    square += v.squaredNorm();
    for (const double part : {v.x(), v.y(), v.z()})
      hash = combine(hash, std::bit_cast<std::uint64_t>(part));
    moving += 1;
  }
  const double deepest = depths.empty() ? 0 : static_cast<double>(depths.back());
  const double p99 = depths.empty() ? 0 : static_cast<double>(depths[depths.size() * 99 / 100]);
  std::printf(
      "%-14s %6zu bodies  ms: first %7.2f  median %6.2f  average %6.2f  worst %6.2f  last60 %6.2f  "
      "| mm: mean "
      "%.3f p99 %.2f max %.1f  | rms %.1e m/s | awake %u contacts %u | %016llx\n"
      "%15s%s\n",
      name, run.ids.size(), ms.front(), sorted[ms.size() / 2], sum / static_cast<double>(ms.size()),
      worst, last / static_cast<double>(tail),
      1e3 * depth / std::max<double>(1, static_cast<double>(depths.size())), 1e3 * p99,
      1e3 * deepest, std::sqrt(square / static_cast<double>(moving)), run.last.awake,
      run.last.contacts, static_cast<unsigned long long>(hash), "", peers);
  std::fflush(stdout);
}

template <class MakeSet>
void settle(const char* name, const MakeSet& make_set, int frames, const Options& options,
            const char* peers) {
  if (options.scene != "all" && options.scene != name) return;
  const Set set = make_set();
  Run run = begin(set, options);
  advance(run, options.frames > 0 ? options.frames : frames, options);
  print(name, run, peers);
}

/// Simulates a standing wall for ten seconds, then a ball of 500 kg that hits it at 20 m/s.
void shoot_wall(const Options& options) {
  if (options.scene != "all" && options.scene != "wall") return;
  Run run = begin(wall(50, 20), options);
  const BodyId top_brick = run.ids[run.ids.size() - 25];  // middle brick of the top course
  const double top = run.physics->state(top_brick).X_WB.position.y();
  advance(run, 600, options);
  const double sink_m = top - run.physics->state(top_brick).X_WB.position.y();
  print("wall", run,
        "Box3D stands, sinks 59 mm, 2.1 ms; PhysX TGS 32 4.5 ms, 1.1 mm; Bullet, ODE, Jolt fall");
  std::printf("%15stop sinks %.2f mm\n", "", 1e3 * sink_m);
  Set shot;
  shot.ball(500, 0.4, Vec3(10, 2, -3), Vec3(0, 0, 20));
  run.physics->replace({}, shot.bodies);
  run.frame_ms.clear();
  advance(run, 180, options);
  print("wall, shot", run, "");
}

void run_all(const Options& options) {
  set_threads(options.threads);
  std::printf("%d thread(s), %.0f Hz, %d substeps, sleeping %s; processor time\n", options.threads,
              options.rate_Hz, options.substeps, options.sleep ? "on" : "off");
  const auto seed = static_cast<std::uint64_t>(options.seed);
  settle(
      "rubble-2000", [=] { return rubble(2000, seed); }, 600, options,
      "Box3D 4.6, 6.3, 9.2 (3.8/67, 1.7/50, 1.7/50 mm); Jolt 6.9 (8.9/70); PhysX TGS 4, 16: "
      "7.1 (.62/36), 9.6 (.075/4.5)");
  settle(
      "rubble-5000", [=] { return rubble(5000, seed); }, 600, options,
      "Box3D 29-31, worst 62-77 (2.6/42 mm, 9e-7 m/s); Jolt 32 (11.3/56); PhysX 31 (1.15/40)");
  if (options.scene == "rubble-20000")
    settle(
        "rubble-20000", [=] { return rubble(20000, seed); }, 420, options,
        "Box3D 216, worst 556 (2.7/71 mm); Jolt 227 (11.7/77); PhysX 157 (1.3/66)");
  shoot_wall(options);
  settle(
      "pyramid", [] { return pyramid(40); }, 300, options,
      "Box3D 1, 2, 4 substeps .8, .9, 1.1 (143, 28, 6.9 mm max); PhysX TGS 4, 16 1.0, 1.6 "
      "(18, 1.1); Jolt 2.0 (18)");
  settle(
      "stack", [] { return stack(50); }, 600, options, "");
  settle(
      "cubes-4913", [] { return touching_cubes(17); }, 60, options,
      "first step, median: Box3D 116, 54; Jolt 36, 31; PhysX 142, 65");
  if (options.scene == "cubes-19683")
    settle(
        "cubes-19683", [] { return touching_cubes(27); }, 30, options,
        "first step, median: Box3D 545, 278; Jolt 244, 261; PhysX 1330, 322");
}

}  // namespace
}  // namespace sunder::solver

int sunder::bench::measure_piles(int argc, char** argv) {
  solver::Options options;
  if (!read_flags(argc, argv,
                  {{"--scene", &options.scene, "NAME"},
                   {"--threads", &options.threads, "N"},
                   {"--substeps", &options.substeps, "N"},
                   {"--sweeps", &options.sweeps, "N"},
                   {"--frames", &options.frames, "N"},
                   {"--rate", &options.rate_Hz, "HZ, >= 60"},
                   {"--colors", &options.colors, "0..64"},
                   {"--lanes", &options.lanes, "N"},
                   {"--seed", &options.seed, "N"},
                   {"--sleep", &options.sleep}},
                  [&] {
                    return options.threads > 0 && options.substeps > 0 && options.sweeps > 0 &&
                           options.colors >= 0 && options.colors <= 64 && options.lanes >= 0 &&
                           options.rate_Hz >= 60;
                  }))
    return kUsageError;
  solver::run_all(options);
  return 0;
}
