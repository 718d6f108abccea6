// A ring of prisms.
#pragma once

#include <numbers>
#include <vector>

#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "fracture/adjacency/compound_builder.h"

namespace sunder::fracture {

/// Returns a ring of `segments` prisms around the y axis, from y = 0 to `height`, in metres.
inline Compound ring_compound(int segments, double inner, double outer, double height) {
  const auto on_circle = [&](double radius, int i) {
    const SinCos angle = sin_cos(2 * std::numbers::pi * (i % segments) / segments);
    return Vec2(radius * Vec2(angle.cos, angle.sin));
  };
  std::vector<Part> parts;
  for (int i = 0; i < segments; ++i) {
    const Vec2 polygon[] = {on_circle(inner, i + 1), on_circle(outer, i + 1), on_circle(outer, i),
                            on_circle(inner, i)};
    parts.push_back({make_prism(polygon, 0, height, false), MaterialIndex(0u), 0});
  }
  return make_compound(std::move(parts));
}

}  // namespace sunder::fracture
