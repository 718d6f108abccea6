// Implements the Breaker interface with fracture patterns (paper 3.1, 3.2).
#pragma once

#include <memory>

#include "engine/model/breaker.h"
#include "fracture/check/failure_log.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/pattern/align.h"
#include "fracture/pattern/pattern_library.h"

namespace sunder::fracture {

/// A command with its pattern, the placement of the pattern and the volume that breaks.
struct PreparedBreak {
  std::shared_ptr<const Pattern> pattern;
  Placement placement;
  ImpactSphere sphere;
};
/// Prepares a command for a compound or structure with the bounding box `bounds_R`.
PreparedBreak prepare_break(const BreakCommand& command, const Box& bounds_R,
                            PatternLibrary& library);

/// Returns a breaker that breaks structures by the pattern of the command and caches patterns.
/// Failed cuts are recorded in `log` unless it is null.
std::unique_ptr<Breaker> make_pattern_breaker(std::shared_ptr<FailureLog> log = nullptr);

}  // namespace sunder::fracture
