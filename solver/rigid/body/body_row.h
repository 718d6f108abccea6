// State of a body in the sweeps of contacts and joints.
#pragma once

#include <cstdint>

#include "engine/base/types.h"
#include "solver/base/wide.h"
#include "solver/rigid/body/slots.h"

namespace sunder::solver {

/// State of a body within a step. Lanes 0 to 2 are linear, 3 to 5 angular (root space).
struct alignas(64) BodyRow {
  Wide velocity;
  Wide position;  ///< Displacement and rotation since the step began.
  Wide base;      ///< Velocity in the substep before any contact impulse.
  Wide start;     ///< Velocity when the step began.
};

/// Returns the row of a dynamic body. Row 0 is immovable. Rows of moving kinematic bodies have
/// indices from -1 downwards and are only read.
inline std::uint32_t row_of(BodySlot body) { return body.value + 1; }

inline Vec3f linear(const Wide& of_row) { return {of_row[0], of_row[1], of_row[2]}; }
inline Vec3f angular(const Wide& of_row) { return {of_row[3], of_row[4], of_row[5]}; }

}  // namespace sunder::solver
