// Convexes that overlap become ghosts (paper 4.3, figure 12), to any mutual depth up to
// kDeepestGhost; what would overlap more deeply is cut apart instead.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// Most convexes that one ghost is the overlap of. n parts in one place would make 2^n ghosts.
inline constexpr std::size_t kDeepestGhost = 4;

/// What two solids have in common, if it is thicker than `tolerance_m`; otherwise empty. Its faces
/// keep the names of theirs.
ConvexPolyhedron overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b, double tolerance_m);

/// Returns convex parts that fill what none of `others` fills of a solid. A part that is cut by a
/// face of another has the opposite name there, so that the two touch. Parts thinner than
/// `tolerance_m` are lost. Throws InputError if there are too many parts.
std::vector<ConvexPolyhedron> subtract(const ConvexPolyhedron& solid,
                                       const std::vector<const ConvexPolyhedron*>& others,
                                       double tolerance_m);

/// Pairs of parts (a < b), ascending.
using PartPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
/// Those whose boxes come within `tolerance_m` of each other.
PartPairs find_pairs(std::span<const Part> parts, double tolerance_m);
/// Those of `pairs` that overlap by more than the tolerance.
PartPairs find_overlaps(std::span<const Part> parts, const PartPairs& pairs, double tolerance_m);

/// Replaces a part that would be in a place where kDeepestGhost parts before it are already, by
/// convex parts that fill what none of those before it does; false if there is none. What is
/// thinner than the tolerance is lost. Throws InputError if that makes too many parts.
bool part_deep_overlaps(std::vector<Part>& parts, const PartPairs& overlaps, double tolerance_m);

/// The ghosts of the pairs of convexes that overlap, and of more of them together, sorted. A ghost
/// is of the material of the last of its convexes, so that the first of them decides what an
/// overlap weighs.
std::vector<Ghost> find_ghosts(std::span<const ConvexPtr> convexes, const PartPairs& overlaps,
                               double tolerance_m);

}  // namespace sunder::fracture
