// What stands between a blast and what is behind it. Internal to engine/world.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/actors/world.h"

namespace sunder {

/// How far off the nearest convex ends in each of many directions from a blast's centre: a map on
/// the six faces of a cube, as a light's shadows are kept. Convexes around the centre cover
/// nothing, nor do balls.
class Cover {
 public:
  /// Of none at all, unless the blast asks for cover.
  Cover(const World& world, const Blast& blast);

  /// Whether a point of a convex of an actor lies behind another convex; of a ball or a chip, that
  /// have none, behind any.
  bool covers(const Vec3& point_W, std::uint32_t actor_key = kNobody, ConvexSlot slot = {}) const;

 private:
  static constexpr std::uint32_t kNobody = 0xffffffff;
  struct Cell {
    double end_m = 1e300;  ///< From the centre.
    std::uint32_t actor_key = kNobody;
    ConvexSlot slot;
  };

  void add(const Convex& convex, const Pose& X_WR, std::uint32_t actor_key, ConvexSlot slot);

  Vec3 center_W_;
  std::vector<Cell> cells_;  ///< Face after face, row after row; empty: no cover.
};

}  // namespace sunder
