// The triangles of the ground: as bodies meet them, and as they are drawn.
#pragma once

#include <memory>
#include <vector>

#include "engine/model/physics.h"
#include "engine/model/scene.h"

namespace sunder {

/// A triangle as a shape of a static body: ShapeDesc::bends.
struct Facet {
  ConvexPolyhedron prism;  ///< In W.
  FacetBends bends;
};

/// One for each triangle, in their order. They are as deep as the surface is coarse, and reach no
/// farther than to the middle of what is thin. Triangles join where they share vertices.
std::vector<Facet> make_facets(const GroundMesh& ground);
/// What is seen, smooth but for creases, in parts of limited size.
std::vector<std::shared_ptr<const Mesh>> make_meshes(const GroundMesh& ground);

}  // namespace sunder
