// Overlap of any two polygons in a plane, which may be concave and have holes.
#pragma once

#include <span>

#include "engine/base/types.h"

namespace sunder::fracture {

/// Outer contours of a polygon, counter-clockwise, and its holes, clockwise.
using Contours = std::span<const std::span<const Vec2>>;
/// Returns the area of the intersection of two polygons; contours are identical if each corner has
/// one of the other within `tolerance`. The result is continuous in the polygons, even where edges
/// coincide up to rounding.
double overlap_area(Contours a, Contours b, double tolerance);

}  // namespace sunder::fracture
