// From manifolds to constraint blocks.
#pragma once

#include <span>
#include <vector>

#include "solver/rigid/bodies.h"
#include "solver/rigid/constraint_block.h"
#include "solver/rigid/contacts.h"

namespace sunder::solver {

/// What prepare() needs besides the manifolds.
struct PrepareStep {
  Vec3f gravity_W = Vec3f::Zero();
  float impulse_scale = 1;     ///< Substep over that of the last step.
  float bounce_speed_m_s = 0;  ///< Slower impacts do not bounce.
};

/// Fills everything but `manifold`, `lanes` and `points`, which say what goes in. `root_W` is by
/// body slot, for bodies that are awake; rows are by slot + 1.
void prepare_block(const Contacts& contacts, const Bodies& bodies, std::span<const Mat3f> root_W,
                   const BodyRow* rows, const PrepareStep& step, ConstraintBlock& block);

/// Hands impulses and final separations back to the manifolds, and lets friction anchors go where
/// the patch slid.
void store_block(const ConstraintBlock& block, const BodyRow* rows, Contacts& contacts);

}  // namespace sunder::solver
