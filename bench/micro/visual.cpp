// Timing of breaks of real meshes.
//
//   SUNDER_MESHES=../shared/meshes build/micro_bench --benchmark_filter=visual/
//
// Targets: dragon_80k in 12 nodes, hit by 50 cells in a quarter of its size, 10 ms; whole bunny_12k
// by 20 cells 8 ms, by 100 cells 25 ms. Time is wall time; CPU is the processor time of all
// threads. Meshes to draw are made later in a step, and are timed separately.
#include <limits>

#include <benchmark/benchmark.h>

#include "bench/micro/skip.h"
#include "bench/real_mesh.h"
#include "engine/base/parallel.h"
#include "engine/model/piece_mesh.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/fracture.h"
#include "fracture/vacd/vacd.h"

namespace sunder::fracture {
namespace {

Compound decomposed(const std::string& name, std::uint32_t nodes) {
  VacdOptions options;
  options.node_count = nodes;
  return decompose(bench::repaired_real_mesh(name), options).compound;
}

/// Times one break event on a prepared structure with a prepared pattern, as in a simulation.
void run_event(benchmark::State& state, const Compound& solid, int cells, double radius_part) {
  set_threads(static_cast<int>(state.range(0)));
  const Structure structure(solid);
  const Box box = bounds(solid);
  const double size = box.extent().maxCoeff();
  const bool whole = radius_part == std::numeric_limits<double>::infinity();
  const Pattern pattern = voronoi_pattern(cells, whole ? 1 : 2, whole, 1);
  // The centre is the vertex of the surface nearest to the middle of the right side of the bounds.
  ImpactSphere sphere{box.center(), radius_part * size};
  double unit = sphere.radius_m;
  if (whole) {
    unit = 0.5 * box.extent().norm();
  } else {
    double nearest = std::numeric_limits<double>::infinity();
    const Vec3 from(box.max.x(), box.center().y(), box.center().z());
    for (const ConvexPtr& convex : solid.convexes) {
      if (convex->is_internal()) continue;
      for (const Vec3& vertex : convex->visual->vertices) {
        if ((vertex - from).norm() >= nearest) continue;
        nearest = (vertex - from).norm();
        sphere.center_R = vertex;
      }
    }
  }
  const Placement placement{unit * Mat3::Identity(), sphere.center_R};
  std::uint64_t event = 0;
  std::size_t pieces = 0;
  for (auto _ : state) {
    const BreakEdit edit = break_structure(structure, pattern, placement, sphere, ++event);
    pieces = edit.loose.pieces.size();
  }
  state.counters["touched"] = static_cast<double>(sphere.touched(structure).size());
  state.counters["convexes"] = static_cast<double>(solid.convexes.size());
  state.counters["pieces"] = static_cast<double>(pieces);
}

void Dragon_of_12_nodes_hit_by_50_cells(benchmark::State& state) {
  if (bench::skip_without(state, "dragon_80k.off")) return;
  static const Compound dragon = decomposed("dragon_80k.off", 12);
  run_event(state, dragon, 50, 0.25);
}
BENCHMARK(Dragon_of_12_nodes_hit_by_50_cells)
    ->Name("visual/Dragon_of_12_nodes_hit_by_50_cells")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void Bunny_whole_by_cells(benchmark::State& state) {
  if (bench::skip_without(state, "bunny_12k.off")) return;
  static const Compound bunny = decomposed("bunny_12k.off", 1);
  run_event(state, bunny, static_cast<int>(state.range(1)),
            std::numeric_limits<double>::infinity());
}
BENCHMARK(Bunny_whole_by_cells)
    ->Name("visual/Bunny_whole_by_cells")
    ->ArgsProduct({{1, 2}, {20, 100}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

/// Times the making of meshes to draw for a bunny in 100 pieces.
void Bunny_in_100_cells_drawn(benchmark::State& state) {
  if (bench::skip_without(state, "bunny_12k.off")) return;
  set_threads(1);
  const Compound solid = decomposed("bunny_12k.off", 1);
  const double unit = 0.5 * bounds(solid).extent().norm();
  const BreakPlan plan = fracture(
      solid, voronoi_pattern(100, 1, true, 1), {unit * Mat3::Identity(), bounds(solid).center()},
      {bounds(solid).center(), std::numeric_limits<double>::infinity()}, 1);
  for (auto _ : state) {
    for (const Compound& piece : plan.pieces) {
      const auto hidden = hidden_faces(piece);
      for (std::size_t c = 0; c < hidden.size(); ++c) {
        benchmark::DoNotOptimize(make_mesh(*piece.convexes[c], hidden[c]));
      }
    }
  }
}
BENCHMARK(Bunny_in_100_cells_drawn)
    ->Name("visual/Bunny_in_100_cells_drawn")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder::fracture
