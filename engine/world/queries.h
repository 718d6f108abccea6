// Ray casts and overlap queries of a world. Internal to engine/world.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/cast.h"
#include "engine/world/actors/world_state.h"
#include "engine/world/world.h"

namespace sunder {

/// Returns what a ray or a moving ball meets first; of several at one distance, that of the lowest
/// key and slot.
std::optional<CastHit> find_first(const WorldState& world, const QueryFilter& filter,
                                  const MovingBall& ball);
/// Returns all that it meets, by distance, key and slot.
std::vector<CastHit> find_all(const WorldState& world, const QueryFilter& filter,
                              const MovingBall& ball);
std::vector<Overlap> find_overlaps(const WorldState& world, const QueryFilter& filter,
                                   const Vec3& center_W, double radius_m);
std::vector<Overlap> find_overlaps(const WorldState& world, const QueryFilter& filter,
                                   const Box& box_W);

}  // namespace sunder
