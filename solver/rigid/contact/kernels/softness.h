// Softness of contacts, from the length of a substep.
#pragma once

#include <cstdint>

namespace sunder::solver {

struct StepContext;

/// A spring and damper in the form of a soft constraint (Catto 2011, "Soft Constraints").
struct Softness {
  float rate = 0;  ///< Rate of correction, 1/s.
  float mass_scale = 1;
  float impulse_scale = 0;
  /// Compression by a steady load: this times the impulse of a substep over the effective mass; s.
  float compliance_s = 0;
};

/// Softness of contacts with one number of points.
struct ContactSoftness {
  Softness normal;    ///< Along the normal.
  Softness friction;  ///< Along the tangents, for static friction.
};

/// Softness of contacts in a substep.
struct SoftStep {
  ContactSoftness edge;  ///< For one or two points.
  ContactSoftness face;  ///< For three or more points: springs in parallel.
  float inverse_h = 0;   ///< 1/s.
  float omega = 1;       ///< Relaxation factor of a sweep.
  /// Maximum speed of correction over the root of the smaller shape's inner radius, √(m)/s.
  float push = 0;
  float landing_m_s = 0;  ///< Minimum closing speed of a landing.

  const ContactSoftness& of(std::uint32_t points) const { return points > 2 ? face : edge; }
};

/// Returns the softness of contacts in the substeps of a step.
SoftStep soft_step(const StepContext& step);

}  // namespace sunder::solver
