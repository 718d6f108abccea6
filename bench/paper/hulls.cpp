// Tightness of hulls fitted to points, as in the paper's figure 13: paper_bench hulls.
// SUNDER_MESHES names the folder with good/bunny_12k.off, which a bumpy ball replaces if missing.
#include <algorithm>
#include <cstdio>
#include <string>

#include "bench/paper/paper_bench.h"
#include "bench/real_mesh.h"
#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/hull.h"
#include "tests/fixtures/flags.h"

namespace sunder::bench {
namespace {

void print_row(const char* name, const Fit& fit, double true_volume) {
  const ConvexPolyhedron hull = fitted_hull(bunny_points(), fit);
  const double size = bounds(hull).extent().maxCoeff();
  double farthest = -1e300;
  for (const ConvexPolyhedron::Face& face : hull.faces) {
    for (const Vec3& p : bunny_points()) farthest = std::max(farthest, face.plane.distance(p));
  }
  std::printf("%-12s %6zu %6zu %8.4f   %s\n", name, hull.faces.size(), hull.vertices.size(),
              mass_properties(hull).volume_m3 / true_volume,
              farthest <= 1e-12 * size ? "yes" : "no");
}

}  // namespace

int measure_hulls(int argc, char** argv) {
  if (!read_flags(argc, argv, {})) return kUsageError;
  const double true_volume = mass_properties(make_hull(bunny_points())).volume_m3;
  std::printf("%zu points\n%-12s %6s %6s %8s   %s\n", bunny_points().size(), "fit", "faces",
              "verts", "ratio", "encloses all");
  print_row("box", {Fit::Kind::kAabb}, true_volume);
  print_row("14-dop", {Fit::Kind::k14Dop}, true_volume);
  print_row("26-dop", {Fit::Kind::k26Dop}, true_volume);
  for (const std::uint32_t n : {4u, 5u, 6u, 8u, 12u, 16u, 20u, 24u, 32u, 48u, 64u}) {
    print_row(("hull:" + std::to_string(n)).c_str(), {Fit::Kind::kHull, n}, true_volume);
  }
  return 0;
}

}  // namespace sunder::bench
