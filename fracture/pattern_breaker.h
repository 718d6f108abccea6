// Fracture by patterns behind the Breaker seam (paper 3.1, 3.2).
#pragma once

#include <memory>

#include "engine/model/breaker.h"
#include "fracture/check/failure_log.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/pattern/align.h"
#include "fracture/pattern/pattern_library.h"

namespace sunder::fracture {

/// A command made ready to be carried out: its pattern, where that lies, and how far it reaches.
struct ReadyBreak {
  std::shared_ptr<const Pattern> pattern;
  Placement placement;
  ImpactSphere sphere;
};
/// What a command means for a compound in the box `bounds_R`.
ReadyBreak make_ready(const BreakCommand& command, const Box& bounds_R, PatternLibrary& library);

/// Carries a command out on a compound that is broken once: its pieces, what is left of it first.
BreakPlan break_compound(const Compound& compound, const BreakCommand& command);

/// Breaks structures by the pattern of the command; patterns are made once and kept. What goes
/// wrong is noted in `log`, if there is one.
std::unique_ptr<Breaker> make_pattern_breaker(std::shared_ptr<FailureLog> log = nullptr);

}  // namespace sunder::fracture
