// How bodies move when nothing touches them, and how their rotation goes on.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"

namespace sunder::solver {

/// Moves a body that touches nothing: the parabola exactly, and rotation that keeps energy and
/// angular momentum (implicit midpoint on the group; both are quadratic invariants of it).
void fly(const StepContext& step, BodySlot body, Bodies& bodies);

/// Moves a kinematic body on, by its velocities as they are.
void carry_on(const StepContext& step, BodySlot body, Bodies& bodies);

/// Which way a body lies, and how it turns (W).
struct Turning {
  Quat R_WB;
  Vec3 w_W;
};
/// Whether free rotation over dt_s changes the angular velocity by anything that matters.
bool wobbles(const Bodies& bodies, BodySlot body, double dt_s);
/// A step of rotation without impulses of a body that wobbles: where it ends, and the angular
/// velocity then, as the body sees it but given in W at today's rotation (it keeps the energy if it
/// then turns with the body).
Turning free_turning(const Bodies& bodies, BodySlot body, double dt_s);
/// With this angular momentum (W).
Turning turning_with(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W);
/// With that, in a rotation at most `reach_rad` from R_WB that has no more than this energy; in
/// R_WB if there is none.
Turning turning_with_energy(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W,
                            double energy_J, double reach_rad);

}  // namespace sunder::solver
