// A break of a compound, without a structure.
#pragma once

#include "fracture/fracture.h"
#include "fracture/pattern_breaker.h"

namespace sunder::fracture {

/// Executes a command on a compound broken once; returns its pieces, the remaining compound first.
inline BreakPlan break_compound(const Compound& compound, const BreakCommand& command) {
  PatternLibrary library;
  const PreparedBreak ready = prepare_break(command, bounds(compound), library);
  return fracture(compound, *ready.pattern, ready.placement, ready.sphere, command.event,
                  command.fit);
}

}  // namespace sunder::fracture
