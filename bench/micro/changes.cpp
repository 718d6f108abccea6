// Timing of what a program changes between two steps, in heaps at rest of different sizes: each
// change has to cost what its neighbours are, not what the world is. And of a frame of a blast with
// and without cover.
//
//   build/micro_bench --benchmark_filter=changes/
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/base/random.h"
#include "engine/geometry/hull.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

constexpr double kFrame_s = 1.0 / 60;

/// Returns a scene of piles of four cubes of 0.2 m, which stand 0.4 m apart.
Scene piles(std::size_t bodies) {
  Scene scene;
  scene.materials = builtin_materials();
  Part part;
  part.polyhedron = make_box(Vec3::Constant(-0.1), Vec3::Constant(0.1));
  part.material = material_named(scene, "brick");
  const Compound cube = make_compound({part});
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(bodies) / 4)) + 1;
  for (std::size_t i = 0; i < bodies; ++i) {
    const std::size_t pile = i / 4;
    Solid solid;
    solid.compound = cube;
    solid.X_WR.position =
        Vec3(0.4 * static_cast<double>(pile % side), 0.1 + 0.2 * static_cast<double>(i % 4),
             0.4 * static_cast<double>(pile / side));
    scene.solids.push_back(std::move(solid));
  }
  return scene;
}

World asleep(std::size_t bodies) {
  World world = make_world(piles(bodies));
  for (int i = 0; i < 60; ++i) world.step(kFrame_s);
  return world;
}

/// Changes the second cube of a pile, and then that of another.
template <typename Change>
void change_one(benchmark::State& state, const Change& change) {
  const auto bodies = static_cast<std::size_t>(state.range(0));
  const World settled = asleep(bodies);
  std::optional<World> world;
  std::size_t next = 0, piles = bodies / 4;
  for (auto _ : state) {
    if (next % 100 == 0) {
      state.PauseTiming();
      world.emplace(settled.copy());
      state.ResumeTiming();
    }
    const std::size_t pile = 7919 * next++ % piles;
    change(*world, BodyKey(4 * pile + 1));
  }
}

void remove_one(benchmark::State& state) {
  change_one(state, [](World& world, BodyKey key) { world.remove(key); });
}

void filter_one(benchmark::State& state) {
  change_one(state, [](World& world, BodyKey key) { world.set_filter(key, {2, 1}); });
}

BENCHMARK(remove_one)
    ->Name("changes/remove")
    ->RangeMultiplier(4)
    ->Range(1000, 64000)
    ->Iterations(200)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(filter_one)
    ->Name("changes/set_filter")
    ->RangeMultiplier(4)
    ->Range(1000, 64000)
    ->Iterations(200)
    ->Unit(benchmark::kMicrosecond);

/// Steps the four frames of a blast too weak to break the boxes around it, on one thread.
void blast_frames(benchmark::State& state, bool cover) {
  const World settled = asleep(1000);
  for (auto _ : state) {
    state.PauseTiming();
    World world = settled.copy();
    world.set_threads(1);
    Blast blast;
    blast.center_W = Vec3(3, 0.4, 3);
    blast.cover = cover;
    blast.impulse_Ns_m2 = 20;
    blast.radius_m = 10;
    world.blast(blast);
    state.ResumeTiming();
    for (int i = 0; i < 4; ++i) world.step(kFrame_s);
  }
}
BENCHMARK_CAPTURE(blast_frames, open, false)
    ->Name("changes/blast/open")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(blast_frames, cover, true)
    ->Name("changes/blast/cover")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder::scenes
