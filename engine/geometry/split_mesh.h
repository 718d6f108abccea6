// Clipping of one mesh to many convex regions, such as the cells of a fracture pattern.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// A plane and its id.
struct NamedPlane {
  Plane plane;
  PlaneId id;
};

/// A convex region: the points with distance <= 0 to all `planes`. `box` encloses the region and
/// may be infinite. Clipping is fastest if the planes closest to the region come first.
struct MeshRegion {
  Box box;
  std::span<const NamedPlane> planes;
};

/// Returns the part of a watertight mesh in each region: within rounding, the result of clip() by
/// the region's planes; empty if no part is inside. Mesh and regions are bisected recursively,
/// since most faces meet few regions. Parallel, with the same bits for any number of threads.
std::vector<PolygonMesh> split(const PolygonMesh& mesh, std::span<const MeshRegion> regions,
                               double tolerance_m);

}  // namespace sunder
