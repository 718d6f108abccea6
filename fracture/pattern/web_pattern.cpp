// The spider web of broken glass: spokes from the impact, joined by rings of straight chords.
#include <cmath>
#include <numbers>

#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "fracture/pattern/pattern.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Returns the crossings of spokes and rings, as (x, z): [ring][spoke], rings from the inside out.
std::vector<std::vector<Vec2>> place_crossings(int rings, int spokes, double jitter,
                                               std::uint64_t seed) {
  Random random(seed, 2);
  const double angle_of_spoke = 2 * std::numbers::pi / spokes;
  std::vector<Vec2> directions;
  for (int spoke = 0; spoke < spokes; ++spoke) {
    const SinCos angle =
        sin_cos(angle_of_spoke * (spoke + kWebSpokeJitter * jitter * random.uniform(-0.5, 0.5)));
    directions.emplace_back(angle.cos, angle.sin);
  }
  std::vector<std::vector<Vec2>> crossings(static_cast<std::size_t>(rings));
  for (int ring = 0; ring < rings; ++ring) {
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double place = ring + 1 + kWebRingJitter * jitter * random.uniform(-0.5, 0.5);
      const double part = place / rings;  // Rings widen outwards as part^1.5.
      const double radius = std::min(kMaxWebRadius, part * std::sqrt(part));
      crossings[static_cast<std::size_t>(ring)].push_back(
          radius * directions[static_cast<std::size_t>(spoke)]);
    }
  }
  return crossings;
}

}  // namespace

Pattern web_pattern(int rings, int spokes, double jitter, std::uint64_t seed) {
  const auto crossings = place_crossings(rings, spokes, jitter, seed);
  const auto ring_count = static_cast<std::uint32_t>(rings);
  const auto spoke_count = static_cast<std::uint32_t>(spokes);
  Pattern pattern;
  pattern.planes = box_planes();
  const std::uint32_t first_spoke = Pattern::kBoxPlanes, first_chord = first_spoke + spoke_count;
  for (std::uint32_t s = 0; s < spoke_count; ++s) {
    pattern.planes.push_back(plane_parallel_to_y(Vec2::Zero(), crossings[0][s]));
  }
  for (std::uint32_t r = 0; r < ring_count; ++r) {
    for (std::uint32_t s = 0; s < spoke_count; ++s) {
      pattern.planes.push_back(
          plane_parallel_to_y(crossings[r][s], crossings[r][(s + 1) % spoke_count]));
    }
  }
  const auto chord = [&](std::uint32_t r, std::uint32_t s) {
    return first_chord + r * spoke_count + s;
  };
  for (std::uint32_t r = 0; r <= ring_count; ++r) {
    for (std::uint32_t s = 0; s < spoke_count; ++s) {
      std::vector<PlaneId> sides{pattern_plane(first_spoke + s, false),
                                 pattern_plane(first_spoke + (s + 1) % spoke_count, true)};
      if (r > 0) sides.push_back(pattern_plane(chord(r - 1, s), true));
      if (r < ring_count) sides.push_back(pattern_plane(chord(r, s), false));
      pattern.cells.push_back({cut_cell(pattern.planes, sides), 0, 0, r == ring_count});
    }
  }
  finish(pattern);
  return pattern;
}

}  // namespace sunder::fracture
