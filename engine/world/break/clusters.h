// Which bodies a break probe looks at: those connected by contacts to an approach that could reach
// something breakable. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/world/actors/world.h"
#include "engine/world/break/break_probe.h"

namespace sunder {

/// Clusters, without the bodies `left_out`, around the approaches of the last collide(); a body
/// that can move is in one at most. What has waited the longest comes first, then the hardest
/// approach.
std::vector<BreakProbe> find_clusters(World& world, const std::vector<Waiter>& left_out);

}  // namespace sunder
