// Bonds that break under a steady load: those whose stress exceeds the strength of their materials.
//
// The stress is solved for, the worst bonds of each overloaded region are cut, and so on until no
// bond is overloaded. Only converged stresses cut bonds, and a solve keeps no state but the initial
// guess of the next: a structure that withstands a load once withstands it forever. Bonds that
// yield are not cut: where no others are overloaded, their sections flow (yielding.h).
#pragma once

#include <vector>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Implements Breaker::stress(): cuts overloaded bonds and separates the pieces that come off.
StressResult break_by_stress(const Structure& structure, const LoadCase& load);

/// Implements Breaker::utilisation(), without a limit of work.
std::vector<float> utilisation_by_stress(const Structure& structure, const LoadCase& load);

}  // namespace sunder::fracture
