// Contacts as the solver sees them: manifolds of one colour side by side, one a lane, in float.
//
// Angular motion is in root space (Bodies::root_B): every body has unit inertia there, so that a
// Jacobian is also the response, and no inertia is multiplied in a sweep. Within a step Jacobians
// are frozen, so separations move by the same Jacobians as velocities.
//
// Mass splitting (Tonge, Benevolenski, Voroshilov 2012) cuts a body into as many equal parts as it
// has split manifolds. A part is n times easier to move, which is said once, in its roots and
// inverse mass: the kernels see the part as a body, whose angular space is √n times as coarse.
#pragma once

#include <array>
#include <cstdint>

#include "solver/base/wide.h"
#include "solver/rigid/body/body_row.h"
#include "solver/rigid/contact/kernels/softness.h"

namespace sunder::solver {

/// What a sweep reads and writes of a point.
template <std::uint32_t lanes>
struct PointLanes {
  Wide3Of<lanes> angular_a, angular_b;  ///< Angular Jacobians along the normal.
  WideOf<lanes> separation;             ///< When the step began.
  WideOf<lanes> mass;                   ///< Effective; 0 where the lane has no such point.
  WideOf<lanes> arm;                    ///< From the friction point: the arm of twist.
  WideOf<lanes> impulse;
};

/// What only rebounds need.
template <std::uint32_t lanes>
struct ReboundLanes {
  WideOf<lanes> restitution;
  WideOf<lanes> fall_m_s2;  ///< With which gravity closes the contact.
  float least_m_s = 0;      ///< Slower impacts do not rebound.
};

/// What only split manifolds need.
template <std::uint32_t lanes>
struct SplitLanes {
  std::uint32_t part_a[lanes] = {};  ///< Where the change of the body goes.
  std::uint32_t part_b[lanes] = {};
  WideOf<lanes> share_a, share_b;  ///< Of a part in its body: 1 / n.
  WideOf<lanes> root_a, root_b;    ///< Its square root.
  /// How much softer the parts are than the bodies, along the normal by point, and sliding.
  std::array<WideOf<lanes>, 4> press_split_scale;
  WideOf<lanes> slide_split_scale;
};

/// What only resistance to rolling needs: angular Jacobians about the two tangents.
template <std::uint32_t lanes>
struct RollLanes {
  Wide3Of<lanes> angular_1_a, angular_1_b, angular_2_a, angular_2_b;
  WideOf<lanes> mass_11, mass_12, mass_22;
  WideOf<lanes> arm;  ///< Of the load; 0: none.
  WideOf<lanes> impulse_1, impulse_2;
};

/// What the impulses of a step did.
template <std::uint32_t lanes>
struct WorkLanes {
  WideOf<lanes> normal_J = {};    ///< Work of normal impulses, on both bodies.
  WideOf<lanes> friction_J = {};  ///< Work of friction, on both bodies.
  WideOf<lanes> drive_J = {};     ///< Work of a kinematic body, on the other.
  WideOf<lanes> allowed_Ns = {};  ///< Friction that Coulomb's law allows,
  WideOf<lanes> excess_Ns = {};   ///< and friction beyond that.
};

/// Manifolds of one colour. What a sweep touches comes first. Alignment is spelled
/// out, or it would follow the instruction set that a file is compiled for.
template <std::uint32_t lanes>
struct alignas(64) ConstraintBlock {
  std::int32_t row_a[lanes] = {};  ///< 0: immovable; less: kinematic, which takes no impulse.
  std::int32_t row_b[lanes] = {};
  std::uint32_t first = 0;   ///< Of the manifolds in lanes, in the list of those to solve.
  std::uint32_t count = 0;   ///< Lanes in use.
  std::uint32_t points = 0;  ///< At most; those that a lane has not have no mass.
  bool split = false;
  bool bouncy = false;  ///< Some lane has restitution.
  bool rolls = false;   ///< Some lane resists rolling.
  alignas(4 * lanes) WideOf<lanes> inverse_mass_a;
  WideOf<lanes> inverse_mass_b;
  Wide3Of<lanes> normal, tangent_1, tangent_2;
  WideOf<lanes> friction;
  WideOf<lanes> face;  ///< 1: three points or more, else 0: which softness it has.
  WideOf<lanes> press_mass, press_give;  ///< Scales of mass and impulse of the spring that presses.
  WideOf<lanes> push_m_s;                ///< Fastest correction of an overlap.
  Wide3Of<lanes> slide_1_a, slide_1_b, slide_2_a, slide_2_b, twist_a, twist_b;  ///< Jacobians.
  WideOf<lanes> slide_11, slide_12, slide_22;  ///< Effective mass, 2×2.
  WideOf<lanes> twist_mass;
  WideOf<lanes> drift_1, drift_2;
  WideOf<lanes> slide_impulse_1, slide_impulse_2, twist_impulse;
  std::array<PointLanes<lanes>, 4> point;

  /// Impulses over the step: those of the points, sliding, twist, rolling.
  std::array<WideOf<lanes>, 9> step_impulse = {};
  Wide3Of<lanes> total;  ///< Impulse on b over the step.
  WorkLanes<lanes> work;
  WideOf<lanes> outside_sign;  ///< +1: a is immovable, −1: b is.
  ReboundLanes<lanes> rebound;
  SplitLanes<lanes> parts;
  RollLanes<lanes> roll;
};

}  // namespace sunder::solver
