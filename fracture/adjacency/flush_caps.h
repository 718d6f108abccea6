// Where the surface of a visual mesh lies flush against a neighbour it can be touched: there it
// becomes a cap, as if a cut had made it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// The mesh, its faces in the planes of the given faces of its polyhedron, within `tolerance_m`,
/// joined into one cap each, by that face's name; itself if none lies there. Caps keep the look
/// that the faces had, and the texture coordinates of their corners.
std::shared_ptr<const PolygonMesh> with_flush_caps(std::shared_ptr<const PolygonMesh> visual,
                                                   const ConvexPolyhedron& polyhedron,
                                                   std::span<const std::uint32_t> flush_faces,
                                                   double tolerance_m);

}  // namespace sunder::fracture
