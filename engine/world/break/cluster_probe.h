// Construction of an impact probe for a cluster of actors. Internal to engine/world.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/impact_probe.h"
#include "engine/world/actors/world_state.h"
#include "engine/world/break/joint_graph.h"

namespace sunder {

/// Actors connected by contacts or joints, ascending by key; a null at the end is the ground.
using Cluster = std::vector<const Actor*>;

/// Returns true if an impact of this energy, impulse and speed may break an actor. Pieces that came
/// off in this step do not break again in it; a static actor can be hit by others.
bool may_break(const WorldState& world, const Actor* actor, double energy_J, double impulse_Ns,
               double speed_m_s);

/// Returns the probe of a cluster: its bodies in the order of the actors, the contacts among them
/// and their joints. May run in parallel once a thread has called Physics::touches() since contacts
/// were found.
std::unique_ptr<ImpactProbe> make_probe(const WorldState& world, const JointGraph& joints,
                                        const Cluster& cluster);

/// Returns a hash of a probe's initial state: bodies, contacts and joints, without the limits at
/// which bodies break.
std::uint64_t fingerprint(const ImpactProbe& probe);

}  // namespace sunder
