// An impact on an actor. Internal to engine/world.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/breaker.h"

namespace sunder {

/// An impact that may break an actor: by a body, by a blast, or by the program.
struct ActorImpact {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  std::uint32_t key = 0;                        ///< Key of the struck actor.
  ConvexSlot convex;                            ///< Struck convex.
  Vec3 point_W = Vec3::Zero();
  Vec3 direction_W = Vec3::UnitY();  ///< Unit, into the actor.
  double energy_J = 0;               ///< Work that the impact can do at the point.
  std::uint32_t blast = 0;           ///< For blasts, and impacts of the program: its number.
  /// For blasts: impulses that bend the actor, N·s in place of N.
  std::vector<AppliedForce> impulses = {};
  /// For impacts of the program: pattern in place of the material's.
  std::optional<PatternSpec> pattern = std::nullopt;
};

}  // namespace sunder
