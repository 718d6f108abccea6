// What touching bodies at rest have to bear, estimated in one pass from the top down: each hands
// its weight, and what lies on it, to what it stands on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/constraint_block.h"

namespace sunder::solver {

/// What a body has to hand down.
struct BodyLoad {
  Vec3f impulse_W = Vec3f::Zero();
  Vec3f angular_impulse_W = Vec3f::Zero();  ///< About its centre.
  bool supported = false;                   ///< By what cannot move, through others or not.
};

/// Gives the points of `manifolds` the impulses (times `kept_scale`) that hand `loads` down to what
/// cannot move. What nothing supports hands down nothing.
void follow_loads(const Vec3& gravity_W, std::span<const ManifoldSlot> manifolds, float kept_scale,
                  const Bodies& bodies, ByBody<BodyLoad>& loads, Contacts& contacts);

/// Bodies that stand on one that is not supported are not supported either.
void release_above(const Vec3& gravity_W, std::span<const ManifoldSlot> manifolds,
                   const Bodies& bodies, const Contacts& contacts, ByBody<BodyLoad>& loads);

}  // namespace sunder::solver
