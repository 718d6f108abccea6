// How bodies move when nothing touches them, and how their rotation goes on.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"

namespace sunder::solver {

/// Moves a body that touches nothing: the parabola exactly, and rotation that keeps energy and
/// angular momentum (implicit midpoint on the group; both are quadratic invariants of it).
void fly(const StepContext& step, BodySlot body, Bodies& bodies);

/// A step of rotation without impulses: where it ends, and the angular velocity then, as the body
/// sees it but given in W at today's rotation (it keeps the energy if it then turns with the body).
struct FreeRotation {
  Quat R_WB;
  Vec3 angular_velocity_W;
};
FreeRotation free_rotation(const Bodies& bodies, BodySlot body, double dt_s);

/// A rotation near R_WB, by at most `reach_rad`, in which a body of this angular momentum (W) has no
/// more than this energy; R_WB itself if there is none.
Quat rotation_with_energy(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W,
                          double energy_J, double reach_rad);

}  // namespace sunder::solver
