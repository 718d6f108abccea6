// Which bodies a break probe looks at: those connected by contacts to an approach that could reach
// something breakable. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/world/actors/world.h"
#include "engine/world/break/break_probe.h"
#include "engine/world/break/waiting_room.h"

namespace sunder {

/// Clusters, without the bodies in the waiting room, around the approaches of the last collide(); a
/// body that can move is in one at most. What has waited the longest comes first, then the hardest
/// approach; approaches with no more than `least_J` are left out.
std::vector<BreakProbe> find_clusters(const World& world, const WaitingRoom& waiting,
                                      double least_J);

/// Moves the bodies of a cluster on as its probe found, once that has ended. The answer is by how
/// much their kinetic energy has grown, J.
double take_over(World& world, const BreakProbe& probe);

}  // namespace sunder
