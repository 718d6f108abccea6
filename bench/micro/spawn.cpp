// Timing of adding bodies and removing convexes. Targets: a solver hull of 16 vertices 2 us, a body
// with such a hull 2 us, removing 50 of 20,000 convexes from a static compound a few microseconds.
#include <numeric>

#include <benchmark/benchmark.h>

#include "bench/piles.h"
#include "engine/geometry/hull.h"
#include "solver/rigid/body/hull.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::solver {
namespace {

std::vector<ConvexPolyhedron> pieces(std::size_t count, std::size_t vertices) {
  Random random(1);
  std::vector<ConvexPolyhedron> made;
  while (made.size() < count) {
    std::vector<Vec3> points(vertices);
    for (Vec3& point : points) point = 0.2 * random.direction();
    made.push_back(make_hull(points));
  }
  return made;
}

void hulls(benchmark::State& state) {
  const auto made = pieces(256, static_cast<std::size_t>(state.range(0)));
  std::size_t i = 0;
  for (auto _ : state) {
    const Hull hull(made[i++ % made.size()], Vec3::Zero());
    benchmark::DoNotOptimize(&hull);
  }
}
BENCHMARK(hulls)->Name("spawn/hulls")->Arg(8)->Arg(16)->Arg(24);

/// Adds a thousand bodies to a new world in one call; the counter `each` is the time per body.
void bodies(benchmark::State& state) {
  constexpr std::size_t kCount = 1000;
  bench::Pile pile;
  const auto made = pieces(kCount, static_cast<std::size_t>(state.range(0)));
  for (std::size_t i = 0; i < kCount; ++i) pile.convex(made[i], Vec3(static_cast<double>(i), 0, 0));
  for (auto _ : state) {
    state.PauseTiming();
    auto physics = make_rigid_physics({});
    state.ResumeTiming();
    benchmark::DoNotOptimize(physics->replace({}, pile.bodies));
    state.PauseTiming();
    physics.reset();
    state.ResumeTiming();
  }
  state.counters["each"] = benchmark::Counter(
      kCount, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(bodies)->Name("spawn/bodies")->Arg(8)->Arg(16)->Unit(benchmark::kMillisecond);

/// Removes 50 convexes at a time from a static block of boxes after a collision step.
void leave(benchmark::State& state) {
  constexpr std::uint32_t kSide = 27, kGone = 50;
  constexpr std::uint32_t kAll = kSide * kSide * kSide;
  std::vector<ConvexPolyhedron> boxes;
  BodyDesc wall;
  wall.is_static = true;
  for (std::uint32_t i = 0; i < kAll; ++i) {
    const Vec3 low(i % kSide, i / kSide % kSide, i / kSide / kSide);
    boxes.push_back(make_box(low, low + Vec3::Ones()));
  }
  for (std::uint32_t i = 0; i < kAll; ++i) {
    ShapeDesc shape;
    shape.hull = &boxes[i];
    shape.tag = i;
    wall.shapes.push_back(shape);
  }
  std::unique_ptr<Physics> physics;
  BodyId id;
  std::uint32_t next = kAll;
  for (auto _ : state) {
    if (next + kGone > kAll) {
      state.PauseTiming();
      physics = make_rigid_physics({});
      id = physics->replace({}, std::span(&wall, 1)).front();
      physics->collide(1.0 / 60);
      next = 0;
      state.ResumeTiming();
    }
    std::uint32_t gone[kGone];
    std::iota(gone, gone + kGone, next);
    next += kGone;
    physics->edit({id, gone, {}});
  }
}
BENCHMARK(leave)->Name("spawn/leave")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sunder::solver
