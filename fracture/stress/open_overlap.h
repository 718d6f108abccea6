// Overlaps under load: the stress where two convexes overlap, and the edit that turns an overlap
// into bonds, which break like all others.
//
// Begin with open_overlap().
#pragma once

#include <optional>
#include <span>

#include "engine/model/breaker.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {

/// Stress of an overlap of two convexes of `compound`, as a fraction of what their materials bear,
/// from the wrench that the second exerts on the first about the centroid of the overlap. Tension
/// and compression act on the cross-section of the part of the first that is inside the second;
/// shear acts on the surface of that part. An estimate, within about a factor of two.
double overlap_utilisation(const Compound& compound, const Ghost& ghost, const Wrench& wrench,
                           std::span<const Material> materials);

/// Returns the edit that takes an overlap of two convexes (slots `a` < `b`) out of a structure. One
/// of both, where possible the smaller, is replaced by convex parts that fill what no other convex
/// fills; the parts touch their neighbours and have bonds. Mass is kept. An overlap with a surface
/// convex has no common volume to cut off: it ceases to hold the two together. Nothing comes off.
BreakEdit open_overlap(const Structure& structure, ConvexSlot a, ConvexSlot b);

}  // namespace sunder::fracture
