// The ground in the running world: a plane, and meshes; it is no actor. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/model/facets.h"
#include "engine/model/particles.h"

namespace sunder {

struct World;

/// The ground's meshes: one body to who looks at it, many to the physics.
struct Landscape {
  std::vector<Facet> facets;
  std::vector<ObstacleShape> obstacles;  ///< The same.
  std::vector<MeshIndex> meshes;         ///< In W.
};

/// Brings the scene's ground into the physics, tagged kGroundKey, and its meshes into the picture.
void add_ground(World& world);

}  // namespace sunder
