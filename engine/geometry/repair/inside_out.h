// Measures how far a closed surface that passes through itself is inside out.
#pragma once

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Returns the volume in m³ in which a watertight mesh has a negative winding number, counted as
/// often as it winds; 0 for a surface that does not pass through itself. It is integrated exactly
/// along parallel lines, at a distance of about 1/64 of the size, between which small parts are
/// missed.
double inside_out_volume(const PolygonMesh& mesh);

}  // namespace sunder
