// The plug that a striker drives out of a solid: a prism of its cross-section and sectors of rings
// around it. The sides of the prism are parallel to the impact, so that it does not jam.
#include <cmath>

#include "engine/base/random.h"
#include "engine/base/roots.h"
#include "fracture/pattern/pattern.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Returns the corners of all rings, from the inside out.
std::vector<std::vector<Vec2>> place_rings(const Plug& plug, double unit_m, Random& random) {
  std::vector<Vec2> section;
  for (const Vec2& corner : plug.section_m) section.push_back(corner / unit_m);
  std::vector<std::vector<Vec2>> rings;
  const auto add = [&](double scale, double jitter) {
    std::vector<Vec2> ring;
    for (const Vec2& corner : section)
      ring.push_back((scale + jitter * random.uniform(-1, 1)) * corner);
    rings.push_back(std::move(ring));
  };
  if (plug.split) add(kPlugCoreScale, 0);
  add(1, 0);
  if (plug.clearance > 1) add(plug.clearance, 0);
  const double reach = plug.reach_m / plug.section_reach_m();
  const double widest = std::max(1.0, reach / plug.clearance);
  double inner = plug.clearance;
  for (int ring = 1; ring <= plug.rings; ++ring) {
    const double outer =
        plug.clearance * positive_power(widest, static_cast<double>(ring) / plug.rings);
    add(outer, kPlugRingJitter * (outer - inner));
    inner = outer;
  }
  return rings;
}

/// Returns the distances of the planes across the axis from the struck face, in units of P.
std::vector<double> place_slices(const Plug& plug, double unit_m, Random& random) {
  std::vector<double> slices;
  if (!(plug.slice_m > 0)) return slices;
  const int count = static_cast<int>(std::lround(plug.depth_m / plug.slice_m));
  for (int i = 1; i < count; ++i) {
    const double place = (i + kPlugSliceJitter * random.uniform(-1, 1)) / count;
    slices.push_back(place * plug.depth_m / unit_m);
  }
  return slices;
}

}  // namespace

Pattern plug_pattern(const Plug& plug, double unit_m, std::uint64_t seed) {
  Random random(seed, 5);
  const auto rings = place_rings(plug, unit_m, random);
  const auto ring_count = static_cast<std::uint32_t>(rings.size());
  const auto spokes = static_cast<std::uint32_t>(plug.section_m.size());
  Pattern pattern;
  pattern.planes = box_planes();
  const std::uint32_t first_spoke = Pattern::kBoxPlanes, first_chord = first_spoke + spokes;
  for (const Vec2& corner : rings[0])
    pattern.planes.push_back(plane_parallel_to_y(Vec2::Zero(), corner));
  for (const std::vector<Vec2>& ring : rings)
    for (std::uint32_t s = 0; s < spokes; ++s)
      pattern.planes.push_back(plane_parallel_to_y(ring[s], ring[(s + 1) % spokes]));
  const auto chord = [&](std::uint32_t r, std::uint32_t s) { return first_chord + r * spokes + s; };
  const auto first_slice = static_cast<std::uint32_t>(pattern.planes.size());
  std::vector<double> slices = place_slices(plug, unit_m, random);
  if (!plug.through) slices.push_back(plug.depth_m / unit_m);
  for (const double y : slices)
    pattern.planes.push_back(Plane::through(Vec3(0, y, 0), Vec3::UnitY()));
  const auto layers = static_cast<std::uint32_t>(slices.size()) + 1;
  const auto add = [&](std::vector<PlaneId> sides, bool outer) {
    ConvexPolyhedron cell = cut_cell(pattern.planes, sides);
    if (!cell.empty()) pattern.cells.push_back({std::move(cell), 0, 0, outer});
  };
  for (std::uint32_t layer = 0; layer < layers; ++layer) {
    std::vector<PlaneId> between;
    if (layer > 0) between.push_back(pattern_plane(first_slice + layer - 1, true));
    if (layer + 1 < layers) between.push_back(pattern_plane(first_slice + layer, false));
    const bool below = !plug.through && layer + 1 == layers;
    std::vector<PlaneId> core = between;
    for (std::uint32_t s = 0; s < spokes; ++s) core.push_back(pattern_plane(chord(0, s), false));
    add(core, below);
    for (std::uint32_t r = 1; r < ring_count; ++r) {
      for (std::uint32_t s = 0; s < spokes; ++s) {
        std::vector<PlaneId> sides = between;
        sides.push_back(pattern_plane(first_spoke + s, false));
        sides.push_back(pattern_plane(first_spoke + (s + 1) % spokes, true));
        sides.push_back(pattern_plane(chord(r - 1, s), true));
        sides.push_back(pattern_plane(chord(r, s), false));
        add(sides, below);
      }
    }
  }
  for (std::uint32_t s = 0; s < spokes; ++s) {
    add({pattern_plane(first_spoke + s, false), pattern_plane(first_spoke + (s + 1) % spokes, true),
         pattern_plane(chord(ring_count - 1, s), true)},
        true);
  }
  finish(pattern);
  return pattern;
}

}  // namespace sunder::fracture
