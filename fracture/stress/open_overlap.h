// Overlaps under load: the stress where two convexes overlap, and the edit that replaces an overlap
// by bonds, which break like all others.
//
// Read first: open_overlap().
#pragma once

#include <span>

#include "engine/model/breaker.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {

/// Returns the utilisation of an overlap of two convexes of `compound`: stress over strength, from
/// the wrench that the second exerts on the first about the centroid of the overlap. The two
/// separate along the surface of one inside the other: the smaller, or that of the first if their
/// materials differ. Shear acts on this surface; tension, compression and bending on its section,
/// or pressure on its sides if it goes all through. An estimate, within about a factor of two.
double overlap_utilisation(const Compound& compound, const Ghost& ghost, const Wrench& wrench,
                           std::span<const Material> materials);

/// Returns the edit that removes an overlap of two convexes (slots `a` < `b`) from a structure. One
/// of them, the smaller where possible, is replaced by convex parts that fill what no other convex
/// fills, with bonds to their neighbours. Mass is conserved. An overlap with a surface convex has
/// no common volume to cut off: it only ceases to hold the two together. Nothing comes off. The
/// edit is empty if a convex would be cut into too many parts (see subtract()); the overlap then
/// holds under any load.
BreakEdit open_overlap(const Structure& structure, ConvexSlot a, ConvexSlot b);

}  // namespace sunder::fracture
