// Estimates the loads of touching bodies at rest, in one pass from the top down: each body passes
// its weight, and the loads from above, to the bodies below it.
#pragma once

#include <span>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/constraint_block.h"

namespace sunder::solver {

/// Impulse that a body passes to the bodies below it.
struct BodyImpulse {
  Vec3f impulse_W = Vec3f::Zero();
  Vec3f angular_impulse_W = Vec3f::Zero();  ///< About the centre of mass.
  bool supported = false;  ///< True if supported by an immovable body, directly or through others.
};

/// Sets the impulses of the points of `manifolds` that pass `loads` down to
/// immovable bodies. A body without support passes no load.
void distribute_loads(const Vec3& gravity_W, std::span<const ManifoldSlot> manifolds,
                      const Bodies& bodies, ByBody<BodyImpulse>& loads, Contacts& contacts);

/// Marks bodies on an unsupported body as unsupported.
void mark_unsupported_above(const Vec3& gravity_W, std::span<const ManifoldSlot> manifolds,
                            const Bodies& bodies, const Contacts& contacts,
                            ByBody<BodyImpulse>& loads);

}  // namespace sunder::solver
