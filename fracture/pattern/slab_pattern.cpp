// Wood: splinters along the grain, made by splitting a box recursively.
#include "engine/base/check.h"
#include "engine/base/random.h"
#include "fracture/pattern/pattern.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Splits the region within `sides` into `count` cells. Each split plane passes through the region
/// itself, so that cells are convex and tile the region for any tilt.
void split(Pattern& pattern, std::vector<PlaneId>& sides, int count, double jitter,
           Random& random) {
  ConvexPolyhedron region = cut_cell(pattern.planes, sides);
  SUNDER_CHECK(!region.empty());
  if (count == 1) {
    pattern.cells.push_back({std::move(region), 0, 0, false});
    return;
  }
  const Box box = bounds(region);
  const Vec3 extent = box.extent();
  const bool across_y = extent.y() * kSlabPreference >= extent.z();
  const Vec3 straight = across_y ? Vec3::UnitY() : Vec3::UnitZ();
  Vec3 tilt;  // drawn in a fixed order, independent of the compiler
  for (int axis = 2; axis >= 0; --axis)
    tilt[axis] = (axis == 0 ? kSlabTiltAlong : kSlabTiltAcross) * random.uniform(-1, 1);
  const Vec3 normal = (straight + jitter * tilt).normalized();
  const int low_count = count / 2;
  const double share = static_cast<double>(low_count) / count - 0.5;
  const Vec3 middle = mass_properties(region).centroid + share * extent.cwiseProduct(straight);
  const auto plane = static_cast<std::uint32_t>(pattern.planes.size());
  pattern.planes.push_back(Plane::through(middle, normal));
  sides.push_back(pattern_plane(plane, false));
  split(pattern, sides, low_count, jitter, random);
  sides.back() = pattern_plane(plane, true);
  split(pattern, sides, count - low_count, jitter, random);
  sides.pop_back();
}

}  // namespace

Pattern slab_pattern(int count, double jitter, std::uint64_t seed) {
  Random random(seed, 5);
  Pattern pattern;
  pattern.planes = box_planes();
  const std::uint32_t first = add_outer_cells(pattern, {Vec3::Constant(-1), Vec3::Constant(1)});
  std::vector<PlaneId> sides;
  for (std::uint32_t i = 0; i < 6; ++i) sides.push_back(pattern_plane(first + i, false));
  split(pattern, sides, count, jitter, random);
  finish(pattern);
  return pattern;
}

}  // namespace sunder::fracture
