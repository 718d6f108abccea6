// Voronoi patterns: a ball of sites, denser towards the impact, in a shell of outer sites.
#include <cmath>
#include <numbers>

#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "fracture/pattern/pattern.h"
#include "fracture/pattern/voronoi.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

// Returns u^exponent for u in [0, 1) from square roots alone, as pow() of the C library differs
// between processors; uses 20 binary digits of the exponent's fraction.
double power(double u, double exponent) {
  double result = 1;
  for (; exponent >= 1; --exponent) result *= u;
  double root = u;
  for (int digit = 0; digit < 20; ++digit) {
    root = std::sqrt(root);
    exponent *= 2;
    if (exponent >= 1) {
      result *= root;
      exponent -= 1;
    }
  }
  return result;
}

/// Returns evenly distributed directions (Fibonacci spiral) times kShellRadius, with jitter.
std::vector<Vec3> shell_sites(Random& random) {
  std::vector<Vec3> sites;
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kShellSites; ++i) {
    const double y = 1 - (2 * i + 1) / static_cast<double>(kShellSites);
    const double ring = std::sqrt(1 - y * y);
    const SinCos angle = sin_cos(golden_angle * i);
    sites.push_back(kShellRadius * Vec3(ring * angle.cos, y, ring * angle.sin) +
                    kShellJitter * random.direction());
  }
  return sites;
}

}  // namespace

Pattern voronoi_pattern(const std::vector<Vec3>& sites) {
  Pattern pattern;
  pattern.planes = box_planes();
  for (ConvexPolyhedron& polyhedron : voronoi_cells(sites, pattern_box(), pattern.planes)) {
    if (!polyhedron.empty()) pattern.cells.push_back({std::move(polyhedron), 0, 0, false});
  }
  finish(pattern);
  return pattern;
}

Pattern voronoi_pattern(int count, double falloff, bool whole, std::uint64_t seed) {
  Random random(seed, 1);
  std::vector<Vec3> sites;
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = random.direction();
    sites.push_back(power(random.uniform(), falloff / 3) * direction);
  }
  if (!whole) {
    const std::vector<Vec3> shell = shell_sites(random);
    sites.insert(sites.end(), shell.begin(), shell.end());
  }
  Pattern pattern = voronoi_pattern(sites);
  for (std::size_t i = static_cast<std::size_t>(count); i < pattern.cells.size(); ++i) {
    pattern.cells[i].outer = true;
  }
  return pattern;
}

}  // namespace sunder::fracture
