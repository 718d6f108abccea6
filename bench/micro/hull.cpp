// Timing of hulls fitted to points. SUNDER_MESHES names the folder with good/bunny_12k.off, which
// a bumpy ball replaces if missing.
#include "engine/geometry/hull.h"

#include <benchmark/benchmark.h>

#include "bench/real_mesh.h"
#include "engine/geometry/approximate_hull.h"

namespace sunder {
namespace {

void directions(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(approximate_hull(bench::bunny_points(), n));
}

void whole_fit(benchmark::State& state) {
  const Fit fit{Fit::Kind::kHull, static_cast<std::uint32_t>(state.range(0))};
  for (auto _ : state) benchmark::DoNotOptimize(fitted_hull(bench::bunny_points(), fit));
}

void dop_fit(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(fitted_hull(bench::bunny_points(), {Fit::Kind::k26Dop}));
}

void true_hull(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_hull(bench::bunny_points()));
}

BENCHMARK(directions)
    ->Name("hull/directions")
    ->Arg(6)
    ->Arg(24)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(whole_fit)
    ->Name("hull/whole_fit")
    ->Arg(6)
    ->Arg(24)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(dop_fit)->Name("hull/dop_fit")->Unit(benchmark::kMillisecond);
BENCHMARK(true_hull)->Name("hull/true_hull")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder
