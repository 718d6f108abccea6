// Meshes damaged in the ways that repairs know.
#pragma once

#include <cstdint>

#include "engine/geometry/raw_mesh.h"

namespace sunder::test {

/// Ways in which meshes come damaged.
enum class Damage : std::uint8_t {
  kUnjoined,       ///< Each polygon has vertices of its own.
  kNudged,         ///< Likewise, and not quite in the same places.
  kDegenerate,     ///< Polygons without area are added.
  kDuplicated,     ///< Some polygons are there twice.
  kDoubled,        ///< All polygons are there a second time, turned round.
  kPartlyDoubled,  ///< Some polygons are there a second time, turned round.
  kTJunctions,     ///< Vertices lie on edges of polygons that do not have them.
  kFlipped,        ///< Some polygons are turned round.
  kInsideOut,      ///< All polygons are turned round.
  kFans,           ///< More polygons hang on some edges.
  kTouching,       ///< A smaller copy touches in a vertex.
  kNested,         ///< A smaller copy inside shares a polygon.
  kCavity,         ///< A smaller copy inside is turned round.
  kHole,           ///< A polygon is missing.
  kWideHole,       ///< Polygons around a vertex are missing.
  kTorn,           ///< A third of all polygons is missing.
  kOverlapping,    ///< A copy is moved by less than the size.
  kTangled,        ///< Vertices are moved so far that the surface passes through itself.
};
inline constexpr int kDamages = static_cast<int>(Damage::kTangled) + 1;
const char* name_of(Damage damage);
RawMesh damaged(const RawMesh& mesh, Damage damage, std::uint64_t seed);

/// Blocks, wedges and plates with corners on a coarse lattice, so that faces, edges and vertices of
/// different ones coincide; some are open, doubled, turned round or given twice.
RawMesh make_lattice_mesh(std::uint64_t seed);
/// A lattice mesh, or a small closed one with up to three kinds of damage.
RawMesh make_hard_mesh(std::uint64_t seed);

}  // namespace sunder::test
