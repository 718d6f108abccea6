// Fracture by patterns behind the Breaker seam (paper 3.1, 3.2).
#pragma once

#include <memory>

#include "engine/world/breaker.h"

namespace sunder::fracture {

/// Breaks compounds by the pattern of the command; patterns are made once and kept.
std::unique_ptr<Breaker> make_pattern_breaker();

}  // namespace sunder::fracture
