// Motion of bodies without contacts, and updates of rotation.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"

namespace sunder::solver {

/// Moves a body without contacts by a step: along the exact parabola, with a rotation that keeps
/// energy and angular momentum (implicit midpoint on the rotation group; both are quadratic
/// invariants of it).
void move_freely(const StepContext& step, BodySlot body, Bodies& bodies);

/// Moves a kinematic body by a step at constant velocities.
void move_kinematic(const StepContext& step, BodySlot body, Bodies& bodies);

/// Rotation of a body, and its angular velocity in W.
struct RotationState {
  Quat R_WB;
  Vec3 w_W;
};
/// True if free rotation over `dt_s` changes the angular velocity by more than rounding.
bool has_gyroscopic_term(const Bodies& bodies, BodySlot body, double dt_s);
/// Returns the rotation of a body after `dt_s` without impulses. The angular velocity is the final
/// one in the frame of the body, given in W at the rotation before the step; it keeps the energy if
/// it then turns with the body.
RotationState free_rotation(const Bodies& bodies, BodySlot body, double dt_s);
/// Returns the rotation `R_WB` and the angular velocity that has the angular momentum `spin_W` (W).
RotationState rotation_with(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W);
/// Returns a rotation within `reach_rad` of R_WB in which the angular momentum `spin_W` has an
/// energy of at most `energy_J`, and its angular velocity; R_WB itself if there is none.
RotationState rotation_with_energy(const Mat3& inertia_B, const Quat& R_WB, const Vec3& spin_W,
                                   double energy_J, double reach_rad);

}  // namespace sunder::solver
