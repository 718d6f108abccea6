// Cover from blasts by convexes between their centres and a point. Internal to engine/world.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Distance at which the nearest convex ends, in each of many directions from a blast's centre: a
/// cube map, like the shadow map of a point light. Convexes around the centre and balls give no
/// cover.
class Cover {
 public:
  /// Makes the map of a blast; an empty one if the blast has no cover.
  Cover(const WorldState& world, const Blast& blast);

  /// Returns true if a point of a convex of an actor is behind another convex; for balls and chips,
  /// which have no convex, behind any.
  bool covers(const Vec3& point_W, std::uint32_t actor_key = kNoActor, ConvexSlot slot = {}) const;

 private:
  static constexpr std::uint32_t kNoActor = 0xffffffff;
  struct Cell {
    double end_m = 1e300;  ///< From the centre.
    std::uint32_t actor_key = kNoActor;
    ConvexSlot slot;
  };

  void add(const Convex& convex, const Pose& X_WR, std::uint32_t actor_key, ConvexSlot slot);

  Vec3 center_W_;
  std::vector<Cell> cells_;  ///< Face by face, row by row; empty: no cover.
};

}  // namespace sunder
