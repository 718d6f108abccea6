// Timing of fracture: patterns, small and large break events, contacts and islands.
//
//   build/micro_bench --benchmark_filter=fracture/Event
//
// Targets (shared machine, one thread unless stated otherwise): pattern of 100 cells 3 ms; 50 cells
// on one convex 1 ms; 30 convexes 3 ms; 50 of 20,000 convexes 5 ms, and on 40,000 at most 1.3 times
// the time on 10,000; contacts and islands of 19,700 convexes from scratch 60 ms.
#include "fracture/fracture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <benchmark/benchmark.h>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/connectivity.h"
#include "fracture/adjacency/islands.h"
#include "fracture/pattern_breaker.h"
#include "fracture/solids.h"

namespace sunder::fracture {
namespace {

BreakCommand impact(const Vec3& at, double radius_m, int cells = 50) {
  BreakCommand command;
  command.pattern.kind = PatternSpec::Kind::kVoronoi;
  command.pattern.cells = cells;
  command.X_RP.position = at;
  command.radius_m = radius_m;
  return command;
}

void Pattern_of_100_cells(benchmark::State& state) {
  set_threads(static_cast<int>(state.range(0)));
  std::uint64_t seed = 0;
  for (auto _ : state) benchmark::DoNotOptimize(voronoi_pattern(100, 2, false, ++seed));
}
BENCHMARK(Pattern_of_100_cells)
    ->Name("fracture/Pattern_of_100_cells")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond);

void run_event(benchmark::State& state, const Compound& solid, const BreakCommand& command) {
  set_threads(1);
  const auto breaker = make_pattern_breaker();
  const Structure structure(solid);
  std::size_t pieces = 0;
  for (auto _ : state) pieces = breaker->plan(structure, command).loose.pieces.size();
  state.counters["pieces"] = static_cast<double>(pieces);
}

void Event_50_cells_on_one_convex(benchmark::State& state) {
  const Compound box = box_compound(Vec3::Constant(-1), Vec3::Constant(1));
  run_event(state, box, impact(Vec3::Zero(), std::numeric_limits<double>::infinity()));
}
BENCHMARK(Event_50_cells_on_one_convex)
    ->Name("fracture/Event_50_cells_on_one_convex")
    ->Unit(benchmark::kMillisecond);

void Event_on_30_convexes(benchmark::State& state) {
  run_event(state, voronoi_compound(30, 1),
            impact(Vec3(.2, .1, .1), std::numeric_limits<double>::infinity()));
}
BENCHMARK(Event_on_30_convexes)
    ->Name("fracture/Event_on_30_convexes")
    ->Unit(benchmark::kMillisecond);

/// A building of about n unit cubes, with an impact sphere that overlaps about 50 of them.
struct Building {
  explicit Building(std::int64_t convexes)
      : side(static_cast<int>(std::cbrt(static_cast<double>(convexes)) + .5)),
        structure(grid_compound(side, side, side, Vec3::Ones(), true)),
        pattern(voronoi_pattern(50, 2, false, 1)) {
    sphere.center_R = Vec3::Constant(side / 2 + .5);
    sphere.radius_m = 1.6;
    placement = {sphere.radius_m * Mat3::Identity(), sphere.center_R};
  }
  int side;
  Structure structure;
  Pattern pattern;
  ImpactSphere sphere;
  Placement placement;
};

void Event_in_a_building(benchmark::State& state) {
  set_threads(1);
  const Building building(state.range(0));
  std::uint64_t event = 0;
  std::size_t pieces = 0;
  for (auto _ : state) {
    const BreakEdit edit = break_structure(building.structure, building.pattern, building.placement,
                                           building.sphere, ++event);
    pieces = edit.loose.pieces.size();
  }
  state.counters["convexes"] = building.structure.size();
  state.counters["bytes_per_convex"] = building.structure.bytes_per_convex();
  state.counters["touched"] =
      static_cast<double>(building.sphere.touched(building.structure).size());
  state.counters["pieces"] = static_cast<double>(pieces);
}
BENCHMARK(Event_in_a_building)
    ->Name("fracture/Event_in_a_building")
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(40000)
    ->Unit(benchmark::kMillisecond);

/// Plans and applies breaks at random places of one building.
void Event_carried_out_in_a_building(benchmark::State& state) {
  set_threads(1);
  Building building(state.range(0));
  Random random(1);
  std::uint64_t event = 0;
  for (auto _ : state) {
    for (int axis = 0; axis < 3; ++axis) {
      building.sphere.center_R[axis] = random.uniform(2, building.side - 2);
    }
    building.placement.origin_R = building.sphere.center_R;
    building.structure.apply(break_structure(building.structure, building.pattern,
                                             building.placement, building.sphere, ++event));
  }
  state.counters["convexes"] = building.structure.size();
}
BENCHMARK(Event_carried_out_in_a_building)
    ->Name("fracture/Event_carried_out_in_a_building")
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(40000)
    ->Iterations(40)
    ->Unit(benchmark::kMillisecond);

/// Finds the islands after the removal of 50 convexes, from the structure's stored links.
void Islands_after_a_break(benchmark::State& state) {
  const Building building(state.range(0));
  const std::vector<ConvexSlot> gone = building.sphere.touched(building.structure);
  std::vector<std::uint32_t> seeds;
  const auto is_gone = [&](ConvexSlot slot) {
    return std::binary_search(gone.begin(), gone.end(), slot);
  };
  for (const ConvexSlot slot : gone) {
    for (const Link& link : building.structure.links(slot)) {
      if (!is_gone(link.other)) seeds.push_back(link.other.value);
    }
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(separate(seeds, [&](std::uint32_t node, const auto& visit) {
      for (const Link& link : building.structure.links(ConvexSlot(node))) {
        if (!is_gone(link.other)) visit(link.other.value);
      }
    }));
  }
}
BENCHMARK(Islands_after_a_break)
    ->Name("fracture/Islands_after_a_break")
    ->Arg(20000)
    ->Unit(benchmark::kMillisecond);

void run_islands(benchmark::State& state, const Compound& solid) {
  set_threads(static_cast<int>(state.range(0)));
  std::size_t contacts = 0;
  for (auto _ : state) {
    const std::vector<Bond> bonds = find_contacts(solid.convexes);
    benchmark::DoNotOptimize(find_islands(solid.convexes.size(), bonds));
    contacts = bonds.size();
  }
  state.counters["convexes"] = static_cast<double>(solid.convexes.size());
  state.counters["contacts"] = static_cast<double>(contacts);
}

void Islands_of_a_brick_grid(benchmark::State& state) {
  run_islands(state, grid_compound(27, 27, 27));
}
BENCHMARK(Islands_of_a_brick_grid)
    ->Name("fracture/Islands_of_a_brick_grid")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond);

void Islands_of_voronoi_cells(benchmark::State& state) {
  run_islands(state, voronoi_compound(19683, 1));
}
BENCHMARK(Islands_of_voronoi_cells)
    ->Name("fracture/Islands_of_voronoi_cells")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder::fracture
