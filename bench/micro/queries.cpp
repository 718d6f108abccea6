// Timing of ray casts and overlap queries in a heap of hulls, and of what they cost a game: a frame
// in which the heap moves, with and without a hundred rays.
//
//   build/micro_bench --benchmark_filter=queries/
#include <cstddef>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/heap.h"
#include "engine/base/random.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

using bench::ray_into;

World heap(int count) { return bench::settled(bench::heap_scene(count)); }

void first_hit(benchmark::State& state, double radius_m) {
  const World world = heap(static_cast<int>(state.range(0)));
  Random random(2, 0);
  std::vector<std::pair<Vec3, Vec3>> rays;
  for (int i = 0; i < 4096; ++i) rays.push_back(ray_into(world, random));
  std::size_t next = 0, hits = 0;
  for (auto _ : state) {
    const auto& [from, along] = rays[next++ % rays.size()];
    hits += world.cast(from, along, 40, radius_m).has_value();
  }
  state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(next);
}
BENCHMARK_CAPTURE(first_hit, ray, 0)->Name("queries/ray")->Arg(1000)->Arg(5000)->Arg(20000);
BENCHMARK_CAPTURE(first_hit, ball, 0.1)->Name("queries/moving_ball")->Arg(5000);

void overlap_ball(benchmark::State& state) {
  const World world = heap(static_cast<int>(state.range(0)));
  Random random(2, 0);
  std::size_t found = 0;
  for (auto _ : state) {
    const BodyArrays& bodies = world.bodies();
    found += world.overlap(bodies.position_W[random.bits() % bodies.key.size()], 0.5).size();
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(state.iterations());
}
BENCHMARK(overlap_ball)->Name("queries/overlap_ball")->Arg(5000);

/// Steps a house that is being shot, with this number of rays and a shot of the program a frame.
void game_loop(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    World world = make_world(load_scene("house", {}, SUNDER_ROOT "/scenes"));
    world.set_threads(1);
    Random random(2, 0);
    state.ResumeTiming();
    for (int i = 0; i < 120; ++i) {
      for (int k = 0; k < state.range(0); ++k) {
        const auto [from, along] = ray_into(world, random);
        benchmark::DoNotOptimize(world.cast(from, along, 40));
      }
      world.step(1.0 / 60);
    }
  }
}
BENCHMARK(game_loop)->Name("queries/game_loop")->Arg(0)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder::scenes
