// Convexes and balls become meshes to draw. A convex is drawn without the faces that its
// neighbours cover (paper 3.1, figure 5: only faces with s < 1 are rendered), a surface convex as
// its visual mesh without the caps that are covered.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/structure.h"

namespace sunder {

/// For each of some convexes of a structure, a flag for each face of its polyhedron: 1 where bonds
/// cover the whole of it, or of the cap of the visual mesh that lies in it.
std::vector<std::vector<std::uint8_t>> hidden_faces(const Structure& structure,
                                                    std::span<const ConvexSlot> slots);
/// The same for all convexes of a compound.
std::vector<std::vector<std::uint8_t>> hidden_faces(const Compound& compound);

/// What is seen of `convex` but for the faces, or caps in faces, whose flag in `hidden` is 1; null
/// if that leaves nothing.
std::shared_ptr<const Mesh> make_mesh(const Convex& convex,
                                      const std::vector<std::uint8_t>& hidden);

/// A sphere about the rest frame's origin.
std::shared_ptr<const Mesh> make_ball_mesh(double radius_m, MaterialIndex material);

}  // namespace sunder
