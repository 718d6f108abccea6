// What is true of pieces, measured from their geometry alone: nothing that made them is asked.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// Figures of pieces.
struct Audit {
  std::size_t pieces = 0;
  std::size_t convexes = 0;
  std::size_t islands = 0;  ///< Connected parts of all pieces; as many as pieces if whole.
  /// Pieces all of whose surfaces are closed, and whose outer surface, without the faces between
  /// convexes, has every edge in exactly two faces.
  std::size_t watertight_pieces = 0;
  std::size_t walled_pieces = 0;     ///< Pieces that have no such outer surface.
  std::size_t open_edges = 0;        ///< Of all surfaces: convexes and their visual meshes.
  std::size_t negative_volumes = 0;  ///< Convexes without volume, or turned inside out.
  double volume_m3 = 0;
  double surface_m3 = 0;  ///< That their surfaces enclose: overlaps count with each of the parts.
  double overlap_m3 = 0;  ///< Of solids of different pieces, pair by pair.
  /// Whether the overlap is exact. Pairs of very large visual meshes are bounded from above
  /// instead.
  bool overlap_is_exact = true;
};

/// Measures them. Parallel.
Audit audit(std::span<const Compound> pieces);

/// Volume that is counted more than once.
struct DoubledVolume {
  double volume_m3 = 0;
  bool is_exact = true;  ///< Otherwise it is bounded from above.
};
/// What convexes with visual meshes have in common with others of their compound, pair by pair: as
/// much of its volume is counted more than once. None where there are too many pairs to measure.
std::optional<DoubledVolume> doubled_volume(const Compound& compound);

/// The volume that two convexes have in common, of their visual meshes where they have any. Sets
/// `exact` to false where it could only be bounded.
double common_volume(const Convex& a, const Convex& b, bool& exact);

}  // namespace sunder::fracture
