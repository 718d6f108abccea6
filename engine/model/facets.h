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
  EdgeAngles bends;
  MaterialIndex material;
};

/// Returns one facet per triangle, in order. The depth follows from the surface's size and edge
/// lengths, and is at most half the local thickness. Triangles that share vertices are neighbours.
std::vector<Facet> make_facets(const GroundMesh& ground);
/// Returns meshes of limited size, with smooth normals except at creases.
std::vector<std::shared_ptr<const Mesh>> make_meshes(const GroundMesh& ground);

}  // namespace sunder
