// Test fixture: meshes with every defect that repairs handle.
#pragma once

#include <cstdint>

#include "engine/geometry/raw_mesh.h"

namespace sunder::test {

/// Defects of meshes.
enum class Damage : std::uint8_t {
  kUnjoined,       ///< Each polygon has its own vertices.
  kNudged,         ///< Each polygon has its own vertices, displaced by a tiny distance.
  kDegenerate,     ///< Polygons without area are added.
  kDuplicated,     ///< Some polygons occur twice.
  kDoubled,        ///< All polygons occur a second time, reversed.
  kPartlyDoubled,  ///< Some polygons occur a second time, reversed.
  kTJunctions,     ///< Vertices lie on edges of polygons that do not have them as corners.
  kFlipped,        ///< Some polygons are reversed.
  kInsideOut,      ///< All polygons are reversed.
  kFans,           ///< Some edges have additional polygons.
  kTouching,       ///< A smaller copy touches the mesh in a vertex.
  kNested,         ///< A smaller copy inside shares a polygon.
  kCavity,         ///< A smaller copy inside is reversed.
  kHole,           ///< A polygon is missing.
  kWideHole,       ///< Polygons around a vertex are missing.
  kTorn,           ///< A third of all polygons is missing.
  kOverlapping,    ///< A copy is displaced by less than the size.
  kTangled,        ///< Vertices are displaced so far that the surface intersects itself.
};
inline constexpr int kDamages = static_cast<int>(Damage::kTangled) + 1;
const char* name_of(Damage damage);
RawMesh damaged(const RawMesh& mesh, Damage damage, std::uint64_t seed);

/// Makes blocks, wedges and plates with corners on a coarse lattice, so that their faces, edges and
/// vertices coincide; some are open, doubled, reversed or duplicated.
RawMesh make_lattice_mesh(std::uint64_t seed);
/// Makes a lattice mesh, or a small closed mesh with up to three defects.
RawMesh make_hard_mesh(std::uint64_t seed);

}  // namespace sunder::test
