// Cover from blasts by convexes between their centres and a point. Internal to engine/world.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Distance at which the nearest convex ends, in each of many directions from a blast's centre: a
/// cube map, like the shadow map of a point light. Convexes around the centre and balls give no
/// cover.
class Cover {
 public:
  /// Makes the map of a blast; an empty one if the blast has no cover. Counts its work.
  Cover(WorldState& world, const Blast& blast);

  /// Returns true if a point of a convex of an actor is behind another convex; for balls and chips,
  /// which have no convex, behind any.
  bool covers(const Vec3& point_W, std::uint32_t actor_key = kNoActor, ConvexSlot slot = {}) const;

 private:
  static constexpr std::uint32_t kNoActor = 0xffffffff;
  /// Nearest end in a direction.
  struct Cell {
    double end_m = 1e300;     ///< From the centre.
    std::uint32_t place = 0;  ///< As in Cast.
    std::uint32_t actor_key = kNoActor;
    ConvexSlot slot;
  };

  /// Rows and columns of a face that a convex may cover; none by default.
  struct CellRange {
    std::array<int, 2> first{1, 1}, last{0, 0};
  };
  /// A convex in reach of the blast.
  struct Cast {
    const Convex* convex;
    std::uint32_t actor_key;
    ConvexSlot slot;
    Quat rotation_RW;
    Vec3 center_R;  ///< Centre of the blast.
    double near_m;  ///< Distance of its box from the centre.
    std::array<CellRange, 6> ranges;
    std::uint32_t place = 0;  ///< In the order of the world.
  };

  static CellRange range_of(const std::array<Vec3, 8>& corners, int face);
  static std::vector<Cast> in_reach(const WorldState& world, const Blast& blast);
  std::uint64_t draw(const Cast& cast, int face, int first_row, int last_row);

  Vec3 center_W_;
  std::vector<Cell> cells_;  ///< Face by face, row by row; empty: no cover.
};

}  // namespace sunder
