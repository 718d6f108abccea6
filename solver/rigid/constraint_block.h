// Contacts as the solver sees them: eight manifolds of one colour side by side, in float.
//
// Angular motion is in root space (Bodies::root_B): every body has unit inertia there, so that a
// Jacobian is also the response, and no inertia is multiplied in a sweep. Within a step Jacobians
// are frozen, so separations move by the same Jacobians as velocities.
#pragma once

#include <array>
#include <cstdint>

#include "solver/rigid/wide.h"

namespace sunder::solver {

/// A body within a step. Lanes: linear 0 to 2, angular (root space) 3 to 5.
struct BodyRow {
  Wide velocity;
  Wide position;  ///< Way and turn since the step began.
  Wide base;      ///< Velocity of the substep before any contact acted.
  Wide start;     ///< Velocity when the step began.
};

struct PointLanes {
  Wide3 turn_a, turn_b;  ///< Angular Jacobians along the normal.
  Wide separation;       ///< When the step began.
  Wide mass;             ///< Effective; 0 where the lane has no such point.
  Wide impulse;
  Wide arm;           ///< From the friction point: the lever of twist.
  Wide rebound;       ///< Restitution: velocity to leave with; 0: none.
  Wide most_impulse;  ///< Restitution: largest impulse of a substep.
};

struct ConstraintBlock {
  std::int32_t row_a[kLanes] = {};  ///< 0: immovable.
  std::int32_t row_b[kLanes] = {};
  std::uint32_t manifold[kLanes] = {};
  std::uint32_t lanes = 0;  ///< In use.
  int points = 0;           ///< Of the manifold that has most.
  bool summed = false;      ///< Some lane touches something immovable, or that bears load.
  bool bouncy = false;      ///< Some point has a rebound.
  Wide inverse_mass_a, inverse_mass_b;
  Wide3 normal, tangent_1, tangent_2;
  Wide friction;
  Wide3 slide_1_a, slide_1_b, slide_2_a, slide_2_b, twist_a, twist_b;  ///< Angular Jacobians.
  Wide slide_11, slide_12, slide_22;                                   ///< Effective mass, 2×2.
  Wide twist_mass;
  Wide drift_1, drift_2;
  Wide slide_impulse_1, slide_impulse_2, twist_impulse;
  Wide outside_sign;  ///< +1: a is immovable, −1: b is.
  Wide3 total;        ///< Impulse on b over the step, if summed.
  std::array<PointLanes, 4> point;
};

/// A spring and damper in the form of a soft constraint (Catto 2011, "Soft Constraints").
struct Softness {
  float rate = 0;  ///< Of correction, 1/s.
  float mass_scale = 1;
  float impulse_scale = 0;
};

/// How soft contacts are in a substep.
struct SoftStep {
  Softness press[4];    ///< Along the normal, by the number of points less one.
  Softness slide[4];    ///< Of friction that sticks.
  float inverse_h = 0;  ///< 1/s.
  float push_m_s = 0;   ///< Fastest correction.
};

}  // namespace sunder::solver
