// Tightness of the hulls of convex decompositions of real meshes: paper_bench decompositions.
// SUNDER_MESHES names the folder with the set good/; without the meshes nothing is measured.
#include <cstdio>
#include <filesystem>
#include <string>

#include "bench/paper/paper_bench.h"
#include "bench/real_mesh.h"
#include "fracture/vacd/vacd.h"
#include "tests/fixtures/flags.h"

namespace sunder::bench {
namespace {

constexpr Fit kTightFit{Fit::Kind::kHull, 64};

void print_row(const std::string& name, const fracture::VacdOptions& options) {
  const fracture::Vacd result = fracture::decompose(repaired_real_mesh(name), options);
  std::printf("%-18s %8u %8zu %8.4f %8zu %8zu %9.1f %9.1f\n", name.c_str(),
              options.convexes ? options.convexes : options.node_count.value_or(0),
              result.compound.convexes.size(), result.figures.hull_volume_ratio(),
              result.compound.bonds.size(), result.figures.max_faces_per_convex,
              result.figures.split_ms, result.figures.total_ms);
}

}  // namespace

int measure_decompositions(int argc, char** argv) {
  if (!read_flags(argc, argv, {})) return kUsageError;
  if (!std::filesystem::exists(real_mesh("bunny_12k.off"))) {
    std::printf("no real meshes: set SUNDER_MESHES\n");
    return 0;
  }
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
  return 0;
}

}  // namespace sunder::bench
