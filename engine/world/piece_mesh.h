// Convexes and balls become meshes to draw. A convex is drawn without the faces that its
// neighbours cover (paper 3.1, figure 5: only faces with s < 1 are rendered).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/compound.h"
#include "engine/world/mesh.h"

namespace sunder {

/// Per convex of a compound, a flag for each face: 1 where bonds cover the whole of it.
std::vector<std::vector<std::uint8_t>> hidden_faces(const Compound& compound);

/// The faces of `convex` whose flag in `hidden` is 0; null if that leaves none.
std::shared_ptr<const Mesh> make_mesh(const Convex& convex,
                                      const std::vector<std::uint8_t>& hidden);

/// A sphere about the rest frame's origin.
std::shared_ptr<const Mesh> make_ball_mesh(double radius_m, MaterialIndex material);

}  // namespace sunder
