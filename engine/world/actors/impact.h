// What hits an actor. Internal to engine/world.
#pragma once

#include <cstdint>

#include "engine/base/types.h"
#include "engine/model/structure.h"

namespace sunder {

/// An impact that may break an actor, as decided from the approaches of a body pair.
struct Impact {
  std::uint32_t key = 0;  ///< The actor that may break.
  ConvexSlot convex;      ///< That is hit.
  Vec3 point_W = Vec3::Zero();
  Vec3 direction_W = Vec3::UnitY();  ///< Unit, into the actor.
  double energy_J = 0;               ///< The work it would do.
  std::uint32_t blast = 0;           ///< Of one: which of the scene's.
};

}  // namespace sunder
