// Timing of the stress solve of a compound under self-weight and slow loads.
//
//   build/micro_bench --benchmark_filter=stress/
//
// Target: 8,000 convexes to a residual of 1e-3 in 10 ms on two cores after a change of load.
// Without a change of load the world does not solve (tests/engine/load_test.cpp).
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/base/parallel.h"
#include "fracture/solids.h"
#include "fracture/stress/stress_breaks.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {
namespace {

const Vec3 kDown(0, -9.81, 0);

StressSystem system_of(const Compound& compound) {
  std::vector<BondGeometry> geometry;
  for (const Bond& bond : compound.bonds) geometry.push_back(bond_geometry(compound, bond));
  return StressSystem(compound, std::move(geometry), std::vector<Material>(1));
}

/// Sets the number of threads and returns the block of convexes that the arguments ask for.
Compound block_of(const benchmark::State& state) {
  set_threads(static_cast<int>(state.range(0)));
  const auto side = static_cast<int>(state.range(1));
  return grid_compound(side, side, side, Vec3::Ones(), true);
}

void show(benchmark::State& state, const SolveResult& result) {
  state.counters["iterations"] = result.iterations;
  state.counters["residual"] = result.residual;
}

/// Sets the arguments: number of threads, then convexes along an edge of the block.
void arguments(benchmark::internal::Benchmark* bench) {
  for (const int side : {10, 20}) {
    for (const int count : {1, 2}) bench->Args({count, side});
  }
  bench->ArgNames({"threads", "side"})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

void Stress_from_nothing(benchmark::State& state) {
  const StressSystem system = system_of(block_of(state));
  SolveResult result;
  for (auto _ : state) {
    std::vector<Displacement> displacements;
    result = system.solve({}, kDown, 1e-3, 500, displacements);
  }
  show(state, result);
}
BENCHMARK(Stress_from_nothing)->Name("stress/Stress_from_nothing")->Apply(arguments);

/// Solves again after a load of a tenth of the compound's weight is put on a corner of the roof.
void Stress_when_the_load_has_changed(benchmark::State& state) {
  const Compound compound = block_of(state);
  const StressSystem system = system_of(compound);
  std::vector<Displacement> settled;
  system.solve({}, kDown, 1e-3, 500, settled);
  const auto roof = static_cast<std::uint32_t>(compound.convexes.size() - 1);
  const Vec3 top = compound.convexes[roof]->solid.centroid;
  const ConvexLoad load{roof, 100.0 * static_cast<double>(compound.convexes.size()) * kDown, top,
                        Vec3::Zero()};
  SolveResult result;
  for (auto _ : state) {
    std::vector<Displacement> displacements = settled;
    result = system.solve(std::span(&load, 1), kDown, 1e-3, 500, displacements);
  }
  show(state, result);
}
BENCHMARK(Stress_when_the_load_has_changed)
    ->Name("stress/Stress_when_the_load_has_changed")
    ->Apply(arguments);

/// Evaluates ten impact loads in one step, at points all over the block.
void Ten_blows(benchmark::State& state) {
  constexpr std::uint32_t kImpacts = 10;
  const Structure structure(block_of(state));
  const Compound compound = structure.compound();
  std::vector<Material> materials(1);
  materials[0].tensile_Pa = materials[0].shear_Pa = materials[0].compressive_Pa = 1e9;
  LoadCase load;
  load.materials = materials;
  load.gravity_R = kDown;
  load.most_work = std::uint64_t{1} << 40;
  load.memory = break_by_stress(structure, load).memory;
  std::vector<AppliedForce> impulses;
  for (std::uint32_t i = 1; i <= kImpacts; ++i) {
    const auto at = static_cast<std::uint32_t>(compound.convexes.size() * i / kImpacts - 1);
    impulses.push_back(
        {ConvexSlot(at), Vec3(std::cos(i), 0, std::sin(i)), compound.convexes[at]->solid.centroid});
  }
  std::vector<ImpulsiveLoad> impacts;
  for (const AppliedForce& impulse : impulses)
    impacts.push_back({std::span(&impulse, 1), 1, impulse.point_R, 0});
  double worst = 0;
  for (auto _ : state) {
    LoadCase one = load;
    for (const ImpulsiveLoad& impact : impacts) {
      one.impulsive_load = impact;
      worst = break_by_stress(structure, one).impulsive_stress.worst;
    }
  }
  state.counters["worst"] = worst;
}
BENCHMARK(Ten_blows)->Name("stress/Ten_blows")->Apply(arguments);

/// Makes a new stress system, as after a break: geometry of bonds and multigrid levels.
void Set_up_after_a_break(benchmark::State& state) {
  const Compound compound = block_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(system_of(compound));
}
BENCHMARK(Set_up_after_a_break)->Name("stress/Set_up_after_a_break")->Apply(arguments);

}  // namespace
}  // namespace sunder::fracture
