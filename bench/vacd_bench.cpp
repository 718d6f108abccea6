// Convex decomposition of real meshes: first tables of the tightness of the hulls, then times.
// SUNDER_MESHES names the folder with the set good/; without the meshes nothing is measured.
#include <cstdio>
#include <filesystem>
#include <map>

#include <benchmark/benchmark.h>

#include "bench/real_mesh.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/vacd/vacd.h"

namespace sunder::fracture {
namespace {

constexpr Fit kTightFit{Fit::Kind::kHull, 64};

const RepairedMesh& mesh(const std::string& name) {
  static std::map<std::string, RepairedMesh> loaded;
  RepairedMesh& mesh = loaded[name];
  if (mesh.shells.empty()) mesh = repair_mesh(read_mesh(bench::real_mesh(name)), name);
  return mesh;
}

void print_row(const std::string& name, const VacdOptions& options) {
  const Vacd result = decompose(mesh(name), options);
  std::printf("%-18s %8u %8zu %8.4f %8zu %8zu %9.1f %9.1f\n", name.c_str(),
              options.convexes ? options.convexes : options.node_count.value_or(0),
              result.compound.convexes.size(), result.figures.hull_volume_ratio(),
              result.compound.bonds.size(), result.figures.max_faces_per_convex,
              result.figures.split_ms, result.figures.total_ms);
}

void print_tables() {
  std::printf("%-18s %8s %8s %8s %8s %8s %9s %9s\n", "mesh", "asked", "convexes", "ratio", "bonds",
              "polygons", "split ms", "total ms");
  for (const char* name : {"bunny_12k.off", "dragon_80k.off", "armadillo_86k.obj"}) {
    print_row(name,
              {.nodes = {}, .node_count = 12, .convexes = 0, .fit = kTightFit, .material = {}});
  }
  for (const char* name :
       {"bunny_12k.off", "fertility_9k.off", "armadillo_86k.obj", "dragon_80k.off"}) {
    for (const std::uint32_t convexes : {12u, 32u, 64u}) {
      print_row(
          name,
          {.nodes = {}, .node_count = {}, .convexes = convexes, .fit = kTightFit, .material = {}});
    }
  }
}

void twelve_nodes(benchmark::State& state, const std::string& name) {
  const RepairedMesh& solid = mesh(name);
  VacdOptions options;
  options.node_count = 12;
  for (auto _ : state) benchmark::DoNotOptimize(decompose(solid, options));
}

void tight(benchmark::State& state, const std::string& name) {
  const RepairedMesh& solid = mesh(name);
  VacdOptions options;
  options.convexes = static_cast<std::uint32_t>(state.range(0));
  options.fit = kTightFit;
  for (auto _ : state) benchmark::DoNotOptimize(decompose(solid, options));
}

BENCHMARK_CAPTURE(twelve_nodes, bunny, "bunny_12k.off")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(twelve_nodes, dragon, "dragon_80k.off")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(twelve_nodes, armadillo, "armadillo_86k.obj")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, bunny, "bunny_12k.off")->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, armadillo, "armadillo_86k.obj")->Arg(32)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, dragon, "dragon_80k.off")->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tight, fertility, "fertility_9k.off")->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder::fracture

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  if (!std::filesystem::exists(sunder::bench::real_mesh("bunny_12k.off"))) {
    std::printf("no real meshes: set SUNDER_MESHES\n");
    return 0;
  }
  sunder::fracture::print_tables();
  benchmark::RunSpecifiedBenchmarks();
}
