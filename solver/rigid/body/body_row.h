// A body as the sweeps of contacts and joints see it.
#pragma once

#include <cstdint>

#include "engine/base/types.h"
#include "solver/base/wide.h"
#include "solver/rigid/body/slots.h"

namespace sunder::solver {

/// A body within a step. Lanes: linear 0 to 2, angular (root space) 3 to 5.
struct alignas(64) BodyRow {
  Wide velocity;
  Wide position;  ///< Way and rotation since the step began.
  Wide base;      ///< Velocity of the substep before any contact acted.
  Wide start;     ///< Velocity when the step began.
};

/// Of a dynamic body. Row 0 stays still; before it lie those of kinematic bodies on their way,
/// counted down from -1: all read them, and nobody writes.
inline std::uint32_t row_of(BodySlot body) { return body.value + 1; }

inline Vec3f linear(const Wide& of_row) { return {of_row[0], of_row[1], of_row[2]}; }
inline Vec3f angular(const Wide& of_row) { return {of_row[3], of_row[4], of_row[5]}; }

}  // namespace sunder::solver
