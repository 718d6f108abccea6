// How soft contacts are, from the length of a substep.
#pragma once

#include <cstdint>

namespace sunder::solver {

struct StepContext;

/// A spring and damper in the form of a soft constraint (Catto 2011, "Soft Constraints").
struct Softness {
  float rate = 0;  ///< Of correction, 1/s.
  float mass_scale = 1;
  float impulse_scale = 0;
  /// How far it gives way under a steady load, s: times the impulse of a substep, over the mass.
  float yield_s = 0;
};

/// How soft contacts of a kind are.
struct ContactSoftness {
  Softness press;  ///< Along the normal.
  Softness slide;  ///< Of friction that sticks.
};

/// How soft contacts are in a substep.
struct SoftStep {
  ContactSoftness edge;  ///< Of one point or two.
  ContactSoftness face;  ///< Of more: springs side by side.
  float inverse_h = 0;   ///< 1/s.
  float omega = 1;       ///< By how much more than it asks for a contact is changed in a sweep.
  /// Fastest correction of an overlap, √(m)/s: times the root of the smaller piece's inner radius.
  float push = 0;

  const ContactSoftness& of(std::uint32_t points) const { return points > 2 ? face : edge; }
};

/// Of the substeps of a step.
SoftStep soft_step(const StepContext& step);

}  // namespace sunder::solver
