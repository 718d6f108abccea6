// Properties of pieces, measured from their geometry, independently of the code that made them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "engine/geometry/repair/surface_audit.h"
#include "engine/model/compound.h"

namespace sunder::fracture {

/// Measured properties of pieces.
struct Audit {
  std::size_t pieces = 0;
  std::size_t convexes = 0;
  /// Connected components of all pieces; equal to `pieces` if all are connected.
  std::size_t islands = 0;
  /// Pieces whose exported surface is sound and has no faces between convexes.
  std::size_t watertight_pieces = 0;
  std::size_t walled_pieces = 0;     ///< Pieces that are exported with faces between convexes.
  std::size_t negative_volumes = 0;  ///< Convexes without volume, or inside out.
  SurfaceAudit surface;   ///< Counts of the exported surfaces; overlaps count once per convex.
  double volume_m3 = 0;   ///< Volume of the exported surfaces; overlaps count once.
  double overlap_m3 = 0;  ///< Overlap of convexes of different pieces, summed over pairs.
  /// False if the overlap of a pair of very large visual meshes is only an upper bound.
  bool overlap_is_exact = true;
};

/// Measures the pieces. Runs in parallel.
Audit audit(std::span<const Compound> pieces);

/// Counts the faults of the surfaces of pieces as they are exported, and sums the counts. Runs in
/// parallel.
SurfaceAudit audit_surfaces(std::span<const Compound> pieces);

/// Volume that is counted more than once.
struct DoubleCountedVolume {
  double volume_m3 = 0;
  /// False if the volume is only an upper bound: for very large visual meshes, and where three
  /// convexes overlap pairwise.
  bool is_exact = true;
};
/// Returns the volume that convexes with visual meshes share with others of their compound, summed
/// over pairs; nullopt if there are too many pairs to measure.
std::optional<DoubleCountedVolume> double_counted_volume(const Compound& compound);

/// Returns the volume of the intersection of two convexes, or of their visual meshes if they have
/// any. Sets `exact` to false if the result is only an upper bound.
double common_volume(const Convex& a, const Convex& b, bool& exact);

}  // namespace sunder::fracture
