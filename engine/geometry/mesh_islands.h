// Connected components of a cut mesh (paper 3.3, island detection).
#pragma once

#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Returns the connected solids that a watertight mesh bounds, in the order of their first
/// contours. The contours of a face may go to several islands. A hole goes with the contour around
/// it, and a cavity with the solid around it. A mesh of one island is returned unchanged.
std::vector<PolygonMesh> islands(PolygonMesh mesh);

}  // namespace sunder
