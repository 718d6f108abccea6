// Triangles of the ground: as collision shapes, and as meshes to draw.
#pragma once

#include <memory>
#include <vector>

#include "engine/model/physics.h"
#include "engine/model/scene.h"

namespace sunder {

/// A triangle as a shape of a static body (ShapeDesc::bends).
struct Facet {
  ConvexPolyhedron prism;  ///< In W.
  FacetBends bends;
};

/// Returns one facet per triangle, in order. A facet's depth depends on the length of the surface's
/// edges and is limited to half the local thickness. Triangles are neighbours if they share
/// vertices.
std::vector<Facet> make_facets(const GroundMesh& ground);
/// Returns meshes of limited size, with smooth normals except at creases.
std::vector<std::shared_ptr<const Mesh>> make_meshes(const GroundMesh& ground);

}  // namespace sunder
