// Clusters of bodies for impact probes: those connected by contacts or joints to a speculative
// contact that could break something. Internal to engine/world.
#pragma once

#include <memory>
#include <vector>

#include "engine/model/impact_probe.h"
#include "engine/world/actors/world_state.h"
#include "engine/world/break/deferred_impacts.h"

namespace sunder {

/// Returns probes of the clusters around the speculative contacts of the last collide() with more
/// than `min_energy_J`, without deferred bodies. A body that can move is in one cluster at most.
/// The longest deferred cluster comes first, then that of the contact with the most energy. Counts
/// clusters of the largest size, and contacts with too little energy that may break a body.
std::vector<std::unique_ptr<ImpactProbe>> find_clusters(const WorldState& world,
                                                        const DeferredImpacts& deferred,
                                                        double min_energy_J, LimitsHit& limits);

/// Applies the motions that an ended probe has found to the bodies of its cluster. Returns the
/// change of their kinetic energy, J.
double apply_motion(WorldState& world, const ImpactProbe& probe);

}  // namespace sunder
