// Timing of convex decomposition of real meshes, which SUNDER_MESHES names.
#include "fracture/vacd/vacd.h"

#include <benchmark/benchmark.h>

#include "bench/micro/skip.h"
#include "bench/real_mesh.h"

namespace sunder::fracture {
namespace {

constexpr Fit kTightFit{Fit::Kind::kHull, 64};

void twelve_nodes(benchmark::State& state, const std::string& name) {
  if (bench::skip_without(state, name)) return;
  const RepairedMesh& solid = bench::repaired_real_mesh(name);
  VacdOptions options;
  options.node_count = 12;
  for (auto _ : state) benchmark::DoNotOptimize(decompose(solid, options));
}

void tight(benchmark::State& state, const std::string& name) {
  if (bench::skip_without(state, name)) return;
  const RepairedMesh& solid = bench::repaired_real_mesh(name);
  VacdOptions options;
  options.convexes = static_cast<std::uint32_t>(state.range(0));
  options.fit = kTightFit;
  for (auto _ : state) benchmark::DoNotOptimize(decompose(solid, options));
}

BENCHMARK_CAPTURE(twelve_nodes, bunny, "bunny_12k.off")
    ->Name("vacd/twelve_nodes/bunny")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(twelve_nodes, dragon, "dragon_80k.off")
    ->Name("vacd/twelve_nodes/dragon")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(twelve_nodes, armadillo, "armadillo_86k.obj")
    ->Name("vacd/twelve_nodes/armadillo")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, bunny, "bunny_12k.off")
    ->Name("vacd/tight/bunny")
    ->Arg(32)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, armadillo, "armadillo_86k.obj")
    ->Name("vacd/tight/armadillo")
    ->Arg(32)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, dragon, "dragon_80k.off")
    ->Name("vacd/tight/dragon")
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, fertility, "fertility_9k.off")
    ->Name("vacd/tight/fertility")
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder::fracture
