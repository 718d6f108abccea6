// What hits an actor. Internal to engine/world.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/breaker.h"

namespace sunder {

/// An impact that may break an actor, as decided from the approaches of a body pair.
struct Impact {
  std::uint32_t key = 0;  ///< The actor that may break.
  ConvexSlot convex;      ///< That is hit.
  Vec3 point_W = Vec3::Zero();
  Vec3 direction_W = Vec3::UnitY();  ///< Unit, into the actor.
  double energy_J = 0;               ///< The work it would do where it hits.
  std::uint32_t blast = 0;           ///< Of one: which of the scene's,
  std::vector<Load> pushes = {};     ///< and all that bends the actor, N·s in place of N.
};

}  // namespace sunder
