// Meshes to draw, made from convexes and balls. A convex is drawn without the faces that its
// neighbours cover (paper 3.1, figure 5: only faces with s < 1 are rendered), a surface convex as
// its visual mesh without covered caps.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/structure.h"

namespace sunder {

/// Returns for each convex in `slots` one flag per face of its polyhedron: 1 if bonds cover the
/// whole face, or the whole cap of the visual mesh that lies in the face.
std::vector<std::vector<std::uint8_t>> hidden_faces(const Structure& structure,
                                                    std::span<const ConvexSlot> slots);
/// Returns the flags of all convexes of a compound.
std::vector<std::vector<std::uint8_t>> hidden_faces(const Compound& compound);

/// Returns the mesh of a convex without faces and caps whose flag in `hidden` is 1; null if empty.
std::shared_ptr<const Mesh> make_mesh(const Convex& convex,
                                      const std::vector<std::uint8_t>& hidden);

/// Returns a sphere around the rest frame's origin.
std::shared_ptr<const Mesh> make_ball_mesh(double radius_m, MaterialIndex material);

}  // namespace sunder
