// Triangulation of one face of a mesh, for rendering and export.
#pragma once

#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/triangulate.h"

namespace sunder {

/// Returns triangles of corners (indices into mesh.corners) that cover a face without its holes.
/// Each edge of a contour is in one triangle, so those of a watertight mesh are watertight. Work is
/// bounded: triangles of a face that exceeds the bound may overlap or extend beyond the face.
std::vector<Triangle> triangulate(const PolygonMesh& mesh, std::size_t face);

}  // namespace sunder
