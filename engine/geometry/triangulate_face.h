// Triangles of one face of a mesh, to draw or export: faces themselves stay polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/triangulate.h"

namespace sunder {

/// Triangles of corners (indices into mesh.corners) that fill the face, holes left out. They have
/// its contours' edges, each once, so that the triangles of a watertight mesh are watertight too;
/// work is bounded, and what is too tangled for it comes out closed, if not well covered.
std::vector<Triangle> triangulate(const PolygonMesh& mesh, std::size_t face);

}  // namespace sunder
