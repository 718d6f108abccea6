// Load case of an actor for the breaker. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/model/breaker.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Returns the load case of self-weight, spin, and contact and joint forces, without a limit of
/// work. `loads` receives the forces and must outlive the load case.
LoadCase make_load_case(const WorldState& world, const Actor& actor, const Quat& rotation_WB,
                        std::vector<AppliedForce>& loads);

/// Appends the loads of a joint that acts on a structure at `at_R` with a force and a torque about
/// that point (or with impulses). A joint without torque acts on the convex nearest to the point. A
/// joint with torque acts on the convexes within half the thickness of the solid there, as on one
/// rigid block: each convex gets the share that accelerates it as a part of the block.
void add_joint_load(const Structure& structure, const Vec3& at_R, const Vec3& force_R,
                    const Vec3& torque_R, std::vector<AppliedForce>& loads);

}  // namespace sunder
