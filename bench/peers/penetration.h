// Penetration depths from poses alone, so that all engines are measured in the same way.
#pragma once

#include <span>
#include <vector>

#include "engine/model/physics.h"

namespace sunder::bench {

/// Returns the depths (m, > 0) of all overlapping pairs, half-spaces included, by the separating
/// axis test in double precision over faces and pairs of edges.
std::vector<double> penetrations(std::span<const BodyDesc> bodies, std::span<const Pose> X_WBs);

}  // namespace sunder::bench
