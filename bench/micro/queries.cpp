// Timing of ray casts and overlap queries in a heap of hulls, and of what they cost a game: a frame
// in which the heap moves, with and without a hundred rays.
//
//   build/micro_bench --benchmark_filter=queries/
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/base/random.h"
#include "engine/geometry/hull.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

/// Returns a world of `count` hulls of 8 to 16 vertices, 0.1 to 0.5 m in size, that have fallen
/// into a heap.
World heap(int count) {
  Scene scene;
  scene.materials = builtin_materials();
  Random random(1, 0);
  const int side = static_cast<int>(std::cbrt(count)) + 1;
  for (int i = 0; i < count; ++i) {
    std::vector<Vec3> points;
    const double size_m = random.uniform(0.1, 0.5);
    const int vertices = 8 + static_cast<int>(random.uniform(0, 9));
    for (int k = 0; k < vertices; ++k) points.push_back(0.5 * size_m * random.direction());
    Part part;
    part.polyhedron = make_hull(points);
    part.material = material_named(scene, "steel");
    Solid solid;
    solid.compound = make_compound({part});
    solid.X_WR.position = 0.5 * Vec3(i % side, 1 + i / (side * side), i / side % side);
    scene.solids.push_back(std::move(solid));
  }
  World world = make_world(std::move(scene));
  world.set_threads(1);
  for (int i = 0; i < 120; ++i) world.step(1.0 / 60);
  return world;
}

/// Returns the start and the direction of a ray into the heap.
std::pair<Vec3, Vec3> ray_into(const World& world, Random& random) {
  const BodyArrays& bodies = world.bodies();
  const Vec3 to = bodies.position_W[random.bits() % bodies.key.size()];
  const Vec3 from = to + 20 * (random.direction() + 1.2 * Vec3::UnitY()).normalized();
  return {from, to - from};
}

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
