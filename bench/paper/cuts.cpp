// Faces, ill-shaped triangles and time of repeated cuts of a prism and a torus with polygonal and
// with triangulated faces, as in the paper's figure 9: paper_bench cuts.
#include <cstdio>
#include <string>

#include "bench/paper/paper_bench.h"
#include "engine/base/trace.h"
#include "engine/geometry/prism.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"
#include "tests/fixtures/flags.h"
#include "tests/fixtures/triangles.h"

namespace sunder::bench {
namespace {

constexpr std::size_t kCuts = 8;

void print_table(const std::string& name, const PolygonMesh& mesh) {
  std::vector<PolygonMesh> polygons = {mesh}, triangles = {triangulated(mesh)};
  std::printf("%s\n%5s %7s %18s %18s %18s\n", name.c_str(), "cuts", "pieces", "polygons/triangles",
              "ill-shaped", "ms");
  const std::vector<Plane> planes = planes_through(bounds(mesh), kCuts);
  for (std::size_t i = 0; i <= kCuts; ++i) {
    double ms[2] = {0, 0};
    if (i > 0) {
      for (const bool in_triangles : {false, true}) {
        auto& pieces = in_triangles ? triangles : polygons;
        const Stopwatch watch;
        pieces = cut_all(pieces, planes[i - 1], {2 * i}, in_triangles);
        ms[in_triangles] = watch.ms();
      }
    }
    std::printf("%5zu %7zu %9zu/%8zu %9zu/%8zu %9.2f/%8.2f\n", i, polygons.size(),
                face_count(polygons), face_count(triangles), ill_shaped(polygons),
                ill_shaped(triangles), ms[0], ms[1]);
  }
}

}  // namespace

int measure_cuts(int argc, char** argv) {
  if (!read_flags(argc, argv, {})) return kUsageError;
  const std::vector<Vec2> hexagon = {{0, 1},  {0.866, 0.5},   {0.866, -0.5},
                                     {0, -1}, {-0.866, -0.5}, {-0.866, 0.5}};
  print_table("a hexagonal prism", polygon_mesh(make_prism(hexagon, 0, 1, false)));
  const std::string torus = SUNDER_ROOT "/scenes/meshes/torus.obj";
  print_table("scenes/meshes/torus.obj", repair_mesh(read_mesh(torus), torus).shells[0]);
  return 0;
}

}  // namespace sunder::bench
