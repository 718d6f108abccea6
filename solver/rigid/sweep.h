// The kernels: one block of eight manifolds against the rows of its bodies.
#pragma once

#include "solver/rigid/constraint_block.h"

namespace sunder::solver {

/// Applies last step's impulses.
void warm_start(ConstraintBlock& block, BodyRow* rows);
/// One Gauss-Seidel pass with the soft bias: pushes overlaps apart.
void sweep_biased(ConstraintBlock& block, BodyRow* rows, const SoftStep& soft);
/// One pass without it: takes out the velocity the push left behind.
void sweep_relaxed(ConstraintBlock& block, BodyRow* rows, const SoftStep& soft);
/// Once, after all substeps: points that took an impulse leave with their rebound velocity.
void bounce(ConstraintBlock& block, BodyRow* rows);
/// Speed of b from a along the normal at a point.
Wide speed_along(const ConstraintBlock& block, int point, const BodyRow* rows);
/// Separation of a point now.
Wide separation_now(const ConstraintBlock& block, int point, const BodyRow* rows);

}  // namespace sunder::solver
