// One mesh cut to many convex regions, such as the cells of a pattern.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// A plane and its name.
struct NamedPlane {
  Plane plane;
  PlaneId id;
};

/// Where all `planes` have distance <= 0; `box` encloses it, and may be infinite. Planes near the
/// region first is fastest.
struct MeshRegion {
  Box box;
  std::span<const NamedPlane> planes;
};

/// The part of a watertight mesh in each region, as clip() by its planes would leave it (within
/// rounding); empty where there is none. A face belongs to few regions, so the mesh is first halved
/// between halves of the regions, and so on. Parallel; the same bits for any number of threads.
std::vector<PolygonMesh> split(const PolygonMesh& mesh, std::span<const MeshRegion> regions,
                               double tolerance_m);

}  // namespace sunder
