// Tightness and cost of hulls fitted to points, as in the paper's figure 13: a table, then times.
// SUNDER_MESHES names the folder with good/bunny_12k.off, which a bumpy ball replaces if missing.
#include <cstdio>
#include <filesystem>

#include <benchmark/benchmark.h>

#include "bench/real_mesh.h"
#include "engine/base/random.h"
#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/hull.h"
#include "engine/io/mesh/mesh_reader.h"

namespace sunder {
namespace {

std::vector<Vec3> load_points() {
  const std::filesystem::path file = bench::real_mesh("bunny_12k.off");
  if (std::filesystem::exists(file)) return read_mesh(file).vertices;
  std::printf("no %s: measuring a bumpy ball instead\n", file.c_str());
  Random random(1);
  std::vector<Vec3> points(6000);
  for (Vec3& p : points) p = random.uniform(0.8, 1) * random.direction();
  return points;
}

const std::vector<Vec3>& points() {
  static const std::vector<Vec3> loaded = load_points();
  return loaded;
}

void print_row(const char* name, const Fit& fit, double true_volume) {
  const ConvexPolyhedron hull = fitted_hull(points(), fit);
  const double size = bounds(hull).extent().maxCoeff();
  double farthest = -1e300;
  for (const ConvexPolyhedron::Face& face : hull.faces) {
    for (const Vec3& p : points()) farthest = std::max(farthest, face.plane.distance(p));
  }
  std::printf("%-12s %6zu %6zu %8.4f   %s\n", name, hull.faces.size(), hull.vertices.size(),
              mass_properties(hull).volume_m3 / true_volume,
              farthest <= 1e-12 * size ? "yes" : "no");
}

void print_table() {
  const double true_volume = mass_properties(make_hull(points())).volume_m3;
  std::printf("%zu points\n%-12s %6s %6s %8s   %s\n", points().size(), "fit", "faces", "verts",
              "ratio", "encloses all");
  print_row("box", {Fit::Kind::kAabb}, true_volume);
  print_row("14-dop", {Fit::Kind::k14Dop}, true_volume);
  print_row("26-dop", {Fit::Kind::k26Dop}, true_volume);
  for (const std::uint32_t n : {4u, 5u, 6u, 8u, 12u, 16u, 20u, 24u, 32u, 48u, 64u}) {
    print_row(("hull:" + std::to_string(n)).c_str(), {Fit::Kind::kHull, n}, true_volume);
  }
}

void directions(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(approximate_hull(points(), n));
}

void whole_fit(benchmark::State& state) {
  const Fit fit{Fit::Kind::kHull, static_cast<std::uint32_t>(state.range(0))};
  for (auto _ : state) benchmark::DoNotOptimize(fitted_hull(points(), fit));
}

void dop_fit(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(fitted_hull(points(), {Fit::Kind::k26Dop}));
}

void true_hull(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_hull(points()));
}

BENCHMARK(directions)->Arg(6)->Arg(24)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(whole_fit)->Arg(6)->Arg(24)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(dop_fit)->Unit(benchmark::kMillisecond);
BENCHMARK(true_hull)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunder

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  sunder::print_table();
  benchmark::RunSpecifiedBenchmarks();
}
