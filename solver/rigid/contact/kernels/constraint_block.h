// Constraint blocks: manifolds of one colour in SIMD lanes, in float.
//
// Angular motion is in root space (Bodies::root_B): each body has unit inertia there, so a Jacobian
// is also the response to an impulse, and a sweep multiplies no inertia. Jacobians are constant
// within a step, so separations and velocities change by the same ones.
//
// Mass splitting (Tonge, Benevolenski, Voroshilov 2012) divides a body into as many equal parts as
// it has split manifolds. A part has n times the inverse mass of the body, and roots scaled by √n:
// the kernels treat it as a body whose angular space is √n times as coarse.
#pragma once

#include <array>
#include <cstdint>

#include "solver/base/wide.h"
#include "solver/rigid/body/body_row.h"
#include "solver/rigid/contact/kernels/softness.h"

namespace sunder::solver {

/// Data of a point in a sweep.
template <std::uint32_t lanes>
struct PointLanes {
  Wide3Of<lanes> angular_a, angular_b;  ///< Angular Jacobians along the normal.
  WideOf<lanes> separation;             ///< At the start of the step.
  WideOf<lanes> mass;                   ///< Effective mass; 0 where the lane has no such point.
  WideOf<lanes> arm;                    ///< Lever arm of twist, from the friction point.
  WideOf<lanes> impulse;
};

/// Data of restitution.
template <std::uint32_t lanes>
struct ReboundLanes {
  WideOf<lanes> restitution;
  WideOf<lanes> fall_m_s2;  ///< Acceleration by gravity that closes the contact.
  float least_m_s = 0;      ///< Slower impacts do not rebound.
};

/// Data of split manifolds.
template <std::uint32_t lanes>
struct SplitLanes {
  std::uint32_t part_a[lanes] = {};  ///< Index of the change of the body's part.
  std::uint32_t part_b[lanes] = {};
  WideOf<lanes> share_a, share_b;  ///< Share of a part in its body: 1 / n.
  WideOf<lanes> root_a, root_b;    ///< Square root of the share.
  /// Compliance of the parts over that of the bodies: along the normal by point, and of friction.
  std::array<WideOf<lanes>, 4> normal_split_scale;
  WideOf<lanes> friction_split_scale;
};

/// Data of rolling resistance: angular Jacobians about the two tangents.
template <std::uint32_t lanes>
struct RollLanes {
  Wide3Of<lanes> angular_1_a, angular_1_b, angular_2_a, angular_2_b;
  WideOf<lanes> mass_11, mass_12, mass_22;
  WideOf<lanes> arm;  ///< Lever arm of the normal impulse; 0: none.
  WideOf<lanes> impulse_1, impulse_2;
};

/// Work of the impulses of a step.
template <std::uint32_t lanes>
struct WorkLanes {
  WideOf<lanes> normal_J = {};    ///< Work of normal impulses on both bodies.
  WideOf<lanes> friction_J = {};  ///< Work of friction on both bodies.
  WideOf<lanes> drive_J = {};     ///< Work of a kinematic body on the other.
  WideOf<lanes> allowed_Ns = {};  ///< Friction impulse that Coulomb's law allows.
  WideOf<lanes> excess_Ns = {};   ///< Friction impulse beyond the allowed one.
};

/// Manifolds of one colour. Data of a sweep comes first. The alignment is explicit, or it would
/// depend on the instruction set that a file is compiled for.
template <std::uint32_t lanes>
struct alignas(64) ConstraintBlock {
  std::int32_t row_a[lanes] = {};  ///< 0: immovable; below 0: kinematic, takes no impulse.
  std::int32_t row_b[lanes] = {};
  std::uint32_t first = 0;   ///< Index of the first manifold in the list to solve.
  std::uint32_t count = 0;   ///< Number of lanes in use.
  std::uint32_t points = 0;  ///< Maximum number of points of a lane; missing points have no mass.
  bool split = false;
  bool bouncy = false;  ///< True if a lane has restitution.
  bool rolls = false;   ///< True if a lane has rolling resistance.
  alignas(4 * lanes) WideOf<lanes> inverse_mass_a;
  WideOf<lanes> inverse_mass_b;
  Wide3Of<lanes> normal, tangent_1, tangent_2;
  WideOf<lanes> friction;
  WideOf<lanes> face;  ///< 1: three points or more, with the softness of a face; else 0.
  /// Mass and impulse scales of the normal springs.
  WideOf<lanes> normal_mass_scale, normal_impulse_scale;
  WideOf<lanes> push_m_s;  ///< Maximum speed at which an overlap is corrected.
  /// Jacobians.
  Wide3Of<lanes> friction_1_a, friction_1_b, friction_2_a, friction_2_b, twist_a, twist_b;
  WideOf<lanes> friction_mass_11, friction_mass_12, friction_mass_22;  ///< Effective mass, 2×2.
  WideOf<lanes> twist_mass;
  WideOf<lanes> drift_1, drift_2;
  WideOf<lanes> friction_impulse_1, friction_impulse_2, twist_impulse;
  std::array<PointLanes<lanes>, 4> point;

  /// Impulses over the step: points, friction, twist, rolling.
  std::array<WideOf<lanes>, 9> step_impulse = {};
  Wide3Of<lanes> total;  ///< Impulse on b over the step.
  WorkLanes<lanes> work;
  WideOf<lanes> outside_sign;  ///< +1: a cannot move; −1: b cannot.
  ReboundLanes<lanes> rebound;
  SplitLanes<lanes> parts;
  RollLanes<lanes> roll;
};

}  // namespace sunder::solver
