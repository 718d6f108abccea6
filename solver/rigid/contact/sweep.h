// The kernels: one block of manifolds against its bodies, for 1, 4, 8 and 16 lanes (sweep_1.cpp and
// so on, each compiled for the instruction set it needs). Read first: sweep() in sweep_kernels.h.
#pragma once

#include "solver/rigid/contact/constraint_block.h"

namespace sunder::solver {

/// What the kernels work on. Rows are by body slot + 1; row 0 stays still.
struct SolverRows {
  BodyRow* rows = nullptr;
  Wide* parts = nullptr;  ///< What split manifolds did to their bodies, to be summed.
};

/// What a block is made of, besides what is stored in it.
template <std::uint32_t lanes>
struct alignas(64) GatheredBlock {
  Wide3Of<lanes> root_a[3] = {}, root_b[3] = {};  ///< Columns.
  Wide3Of<lanes> drift = {}, slide_impulse = {}, friction_arm_a = {}, friction_arm_b = {};
  Wide3Of<lanes> roll_impulse = {};
  Wide3Of<lanes> arm_a[4] = {}, arm_b[4] = {};
  Wide3Of<lanes> gravity = {};  ///< Acceleration of b from a.
  WideOf<lanes> restitution = {};
  Softness press;                       ///< By the number of points.
  WideOf<lanes> compliance_scale = {};  ///< Of the springs that press.
  WideOf<lanes> awake_a = {}, awake_b = {};
  WideOf<lanes> parts_a = {}, parts_b = {};  ///< Into which a split block cuts its bodies.
  float bounce_speed_m_s = 0;                ///< Slower impacts do not bounce.
  bool sleepers = false;
};

/// Works out Jacobians and masses.
template <std::uint32_t lanes>
void derive(GatheredBlock<lanes>& gathered, const SolverRows& bodies,
            ConstraintBlock<lanes>& block);
/// Applies last step's impulses.
template <std::uint32_t lanes>
void warm_start(ConstraintBlock<lanes>& block, const SolverRows& bodies);
/// One Gauss-Seidel pass with the soft bias: pushes overlaps apart.
template <std::uint32_t lanes>
void sweep_biased(ConstraintBlock<lanes>& block, const SolverRows& bodies, const SoftStep& soft);
/// One pass without it: takes out the velocity the push left behind.
template <std::uint32_t lanes>
void sweep_relaxed(ConstraintBlock<lanes>& block, const SolverRows& bodies, const SoftStep& soft);
/// Adds the impulses of a substep to those of the step, where they are summed.
template <std::uint32_t lanes>
void sum_impulses(ConstraintBlock<lanes>& block);
/// Takes impulses of the substep back but for the shares of their bodies, by row. To be called
/// after their sum.
template <std::uint32_t lanes>
void scale_impulses(ConstraintBlock<lanes>& block, const float* share_of_row);
/// What conjugate gradients remember of a block, by impulse: those of its points, of sliding, of
/// twist.
template <std::uint32_t lanes>
struct alignas(64) SearchLanes {
  alignas(4 * lanes) WideOf<lanes> start[7] = {};  ///< Before the sweep.
  WideOf<lanes> direction[7] = {};                 ///< Where they went before that.
};
/// Notes the impulses before a sweep.
template <std::uint32_t lanes>
void mark(const ConstraintBlock<lanes>& block, SearchLanes<lanes>& search);
/// Writes the energy of what a sweep changed, by lane.
template <std::uint32_t lanes>
void measure(const ConstraintBlock<lanes>& block, const SearchLanes<lanes>& search, float* energy);
/// After a sweep: goes on along the way so far, `beta` times as far; 0: the way begins anew.
template <std::uint32_t lanes>
void go_on(ConstraintBlock<lanes>& block, SearchLanes<lanes>& search, const SolverRows& bodies,
           float beta);
/// Once, after all substeps: points that took an impulse leave with their rebound velocity.
template <std::uint32_t lanes>
void bounce(ConstraintBlock<lanes>& block, const SolverRows& bodies);
/// Writes the separation of every point now, by point and lane.
template <std::uint32_t lanes>
void separations_now(const ConstraintBlock<lanes>& block, const SolverRows& bodies,
                     float (*separation)[lanes]);

}  // namespace sunder::solver
