// What a steady load breaks: bonds whose stress exceeds what their materials stand.
//
// Stress is solved for; the worst bonds of every overloaded region are cut, and it is solved for
// again, until nothing is overloaded. Only a converged stress cuts, and nothing is kept of one
// besides a start for the next: a load that a structure withstands once it withstands for ever.
// Bonds that yield are not cut: where no others are overloaded, their sections flow (yielding.h).
#pragma once

#include <vector>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// What Breaker::stress() answers: cuts the bonds that the load is too much for, and what comes
/// off.
StressResult break_by_stress(const Structure& structure, const LoadCase& load);

/// What Breaker::utilisation() answers, however much work it takes.
std::vector<float> utilisation_by_stress(const Structure& structure, const LoadCase& load);

}  // namespace sunder::fracture
