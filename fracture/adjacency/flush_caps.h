// Turns those parts of a visual mesh's surface that lie flush with a neighbour into caps, as if a
// cut had made them, so that they can be in contact.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// Returns the mesh with its faces in the plane of each of the given faces of its polyhedron,
/// within `tolerance_m`, joined into one cap with that face's id; returns the mesh itself if there
/// are no such faces. Caps keep the texture of the faces and the texture coordinates of their
/// corners.
std::shared_ptr<const PolygonMesh> with_flush_caps(std::shared_ptr<const PolygonMesh> visual,
                                                   const ConvexPolyhedron& polyhedron,
                                                   std::span<const std::uint32_t> flush_faces,
                                                   double tolerance_m);

}  // namespace sunder::fracture
