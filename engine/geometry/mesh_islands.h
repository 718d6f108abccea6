// The parts of a cut mesh that no longer hang together (paper 3.3, island detection).
#pragma once

#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// The connected solids that a watertight mesh bounds, by their first contour. A face that several
/// islands share is split between them, a hole goes with the contour around it, and a hollow with
/// the solid around it. A mesh in one part comes back as it was.
std::vector<PolygonMesh> islands(PolygonMesh mesh);

}  // namespace sunder
