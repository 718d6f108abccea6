// What a cluster of bodies is to a break probe. Internal to engine/world.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/actors/world.h"
#include "engine/world/break/break_probe.h"
#include "engine/world/break/joint_graph.h"

namespace sunder {

/// Actors that touch or are joined, ascending by key; the ground, if it is among them, is a null
/// behind them all.
using Cluster = std::vector<const Actor*>;

/// Returns true if an impact of this energy, impulse and speed may break an actor. Pieces that came
/// off in this step do not break again in it; a static actor can be hit by others.
bool may_break(const World& world, const Actor* actor, double energy_J, double impulse_Ns,
               double speed_m_s);

/// The bodies of a cluster in the order of its actors, the contacts among them and their joints.
/// Any number of threads may ask once one has asked for touches since contacts were found.
BreakProbe make_probe(const World& world, const JointGraph& joints, const Cluster& cluster);

/// Of what a probe begins with: the same again if and only if the same bodies meet in the same way.
/// What it takes to break them is left out.
std::uint64_t fingerprint(const BreakProbe& probe);

}  // namespace sunder
