// How much any two polygons in a plane overlap, with holes and all.
#pragma once

#include <span>

#include "engine/base/types.h"

namespace sunder::fracture {

/// The outer contours of a polygon, counter-clockwise, and its holes, clockwise.
using Contours = std::span<const std::span<const Vec2>>;
/// Area that any two polygons have in common; contours of which every corner has one of the other
/// within `near` are the same. It changes as little as the polygons do, even where edges coincide
/// but for rounding.
double overlap_area(Contours a, Contours b, double near);

}  // namespace sunder::fracture
