// Ghosts for convexes that overlap (paper 4.3, figure 12), up to kMaxConvexesPerGhost convexes in
// one place; deeper overlaps are cut away.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// Limit of convexes per ghost, as n parts in one place would have 2^n ghosts.
inline constexpr std::size_t kMaxConvexesPerGhost = 4;

/// Returns the intersection of two polyhedra, with the plane ids of their faces; empty unless it is
/// thicker than `tolerance_m`.
ConvexPolyhedron overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b, double tolerance_m);

/// Returns convex parts of `solid` that lie outside all `others`. A part that is cut by a face of
/// another has the opposite plane id there, so that the two touch. Parts thinner than `tolerance_m`
/// are dropped. Throws InputError if there are too many parts.
std::vector<ConvexPolyhedron> subtract(const ConvexPolyhedron& solid,
                                       const std::vector<const ConvexPolyhedron*>& others,
                                       double tolerance_m);

/// Pairs of parts (a < b), ascending.
using PartPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
/// Returns the pairs of parts whose boxes come within `tolerance_m` of each other.
PartPairs find_pairs(std::span<const Part> parts, double tolerance_m);
/// Returns those of `pairs` that overlap by more than the tolerance.
PartPairs find_overlaps(std::span<const Part> parts, const PartPairs& pairs, double tolerance_m);

/// Replaces each part that overlaps kMaxConvexesPerGhost parts before it in one place by convex
/// parts, which fill what no part before it fills; returns false if there is no such part. Remains
/// thinner than the tolerance are dropped. Throws InputError if too many parts result.
bool cut_deep_overlaps(std::vector<Part>& parts, const PartPairs& overlaps, double tolerance_m);

/// Returns the ghosts of two and more overlapping convexes, sorted. A ghost has the material of the
/// last of its convexes, so that an overlap has the density of the first.
std::vector<Ghost> find_ghosts(std::span<const ConvexPtr> convexes, const PartPairs& overlaps,
                               double tolerance_m);

}  // namespace sunder::fracture
