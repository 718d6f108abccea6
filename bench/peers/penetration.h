// How deep pieces overlap, from their poses alone: one judge for all engines.
#pragma once

#include <span>
#include <vector>

#include "engine/model/physics.h"

namespace sunder::bench {

/// Depths (m, > 0) of all pairs that overlap, half-spaces included, by the separating axis test in
/// double precision over faces and pairs of edges.
std::vector<double> penetrations(std::span<const BodyDesc> bodies, std::span<const Pose> X_WBs);

}  // namespace sunder::bench
