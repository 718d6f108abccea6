// How bodies move when nothing touches them, and how their rotation goes on.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"

namespace sunder::solver {

/// Moves a body that touches nothing: the parabola exactly, and rotation that keeps energy and
/// angular momentum (implicit midpoint on the group; both are quadratic invariants of it).
void fly(const StepContext& step, BodySlot body, Bodies& bodies);

/// What free rotation over dt_s adds to the angular velocity of an uneven body as the body sees it
/// (the gyroscopic term, given in W at today's rotation); zero where it is too slow to matter. It
/// keeps the energy, provided that the velocity then turns with the body.
Vec3 gyroscopic_change(const Bodies& bodies, BodySlot body, double dt_s);

}  // namespace sunder::solver
