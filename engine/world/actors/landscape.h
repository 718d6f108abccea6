// The ground in the running world: a plane and meshes, which are no actors. Internal to
// engine/world.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/facets.h"
#include "engine/model/particles.h"

namespace sunder {

class Archive;
struct WorldState;

/// Meshes of the ground: one body in frames, several in the physics.
struct Landscape {
  /// Shared with copies of the world.
  std::shared_ptr<const std::vector<Facet>> facets;
  std::vector<ObstacleShape> obstacles;  ///< Shapes of the facets, for the particles.
  std::vector<MeshIndex> meshes;         ///< Drawn meshes, in W.
};

/// Writes or reads the meshes of the ground.
void archive(Archive& bytes, Landscape& landscape);

/// Shape tag of the ground's plane; facets have their index in Landscape::facets.
inline constexpr std::uint32_t kGroundPlaneTag = 0xffffffff;

/// Adds the scene's ground to the physics, tagged kGroundKey, and its meshes to those that are
/// drawn.
void add_ground(WorldState& world);

}  // namespace sunder
