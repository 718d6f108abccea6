// The kernels: one block of manifolds against its bodies, for 1, 4, 8 and 16 lanes (sweep_1.cpp and
// so on, each compiled for the instruction set it needs). Read first: sweep() in sweep_kernels.h.
#pragma once

#include "solver/rigid/contact/kernels/constraint_block.h"

namespace sunder::solver {

/// What the kernels work on. Rows are by body slot + 1; row 0 stays still.
struct SolverRows {
  BodyRow* rows = nullptr;
  Wide* parts = nullptr;  ///< What split manifolds did to their bodies, to be summed.
  Wide* spins = nullptr;  ///< Angular momentum (root space) that bodies get when the step ends.
};

/// Of a substep, or of the size of a contact: as good as none.
inline constexpr float kNow = 0.01f;

/// How the arms of a block's impulses follow its bodies within a step. An impulse and its
/// counterpart act at one point, where the body whose corners touch the other's face has it; or the
/// two would change the sum of angular momentum by what the bodies move past each other.
template <std::uint32_t lanes>
struct alignas(64) ArmLanes {
  alignas(4 * lanes) Wide3Of<lanes> root_a[3] = {};  ///< Columns; zero where it takes no impulse.
  Wide3Of<lanes> root_b[3] = {};
  WideOf<lanes> share_a = {};  ///< Of the gap that arms of a bridge; those of b bridge the rest.
  WideOf<lanes> least = {};    ///< Square of a change of the gap too small to follow.
  WideOf<lanes> wide = {};  ///< Square of a gap that no body spans; balls span none, or they spin.
  WideOf<lanes> near = {};  ///< Square of a distance along the normal that is as good as none.
  Wide3Of<lanes> gap = {};  ///< From a's point of friction to b's when the step began.
  Wide3Of<lanes> bridged = {};
  Wide3Of<lanes> moved_by = {};             ///< Impulse on b with which the bodies last moved.
  Wide3Of<lanes> owed_a = {}, owed_b = {};  ///< What impulses would do with the new arms, besides.
  bool owes = false;
};

/// What a block is made of, besides what is stored in it.
template <std::uint32_t lanes>
struct alignas(64) GatheredBlock {
  Wide3Of<lanes> root_a[3] = {}, root_b[3] = {};  ///< Columns.
  Wide3Of<lanes> drift = {}, slide_impulse = {}, friction_arm_a = {}, friction_arm_b = {};
  Wide3Of<lanes> roll_impulse = {};
  Wide3Of<lanes> arm_a[4] = {}, arm_b[4] = {};
  Wide3Of<lanes> offset = {};  ///< Of b's centre from a's.
  WideOf<lanes> share_a = {};  ///< As in ArmLanes.
  Wide3Of<lanes> gap = {}, bridged = {};
  WideOf<lanes> meets = {};       ///< 1: arms bridge the gap from the start.
  Wide3Of<lanes> gravity = {};    ///< Acceleration of b from a.
  WideOf<lanes> has[4] = {};      ///< 1: the manifold has such a point.
  WideOf<lanes> press_mass = {};  ///< Scales of the spring that presses.
  WideOf<lanes> press_give = {};
  WideOf<lanes> compliance_scale = {};       ///< Of the springs that press.
  WideOf<lanes> awake_a = {}, awake_b = {};  ///< Kinematic bodies count.
  WideOf<lanes> parts_a = {}, parts_b = {};  ///< Into which a split block cuts its bodies.
  bool sleepers = false;
};

/// Works out Jacobians and masses.
template <std::uint32_t lanes>
void derive(GatheredBlock<lanes>& gathered, ConstraintBlock<lanes>& block);
/// After the bodies moved: Jacobians and masses with arms that followed them, or, where they are
/// still far from each other, aim at where they meet within a substep of `h_s`. What impulses of
/// this substep did with the old arms stands; what they would do besides is owed to the next.
template <std::uint32_t lanes>
void follow(ConstraintBlock<lanes>& block, ArmLanes<lanes>& arms, const SolverRows& bodies,
            float h_s);
/// Once a substep has begun with the impulses of the one before: what follow() left owed.
template <std::uint32_t lanes>
void settle(ConstraintBlock<lanes>& block, ArmLanes<lanes>& arms, const SolverRows& bodies);
/// Applies last step's impulses.
template <std::uint32_t lanes>
void warm_start(ConstraintBlock<lanes>& block, const SolverRows& bodies);
/// One Gauss-Seidel pass with the soft bias: pushes overlaps apart.
template <std::uint32_t lanes>
void sweep_biased(ConstraintBlock<lanes>& block, const SolverRows& bodies, const SoftStep& soft);
/// One pass without it: takes out the velocity the push left behind.
template <std::uint32_t lanes>
void sweep_relaxed(ConstraintBlock<lanes>& block, const SolverRows& bodies, const SoftStep& soft);
/// Adds the impulses of a substep to those of the step.
template <std::uint32_t lanes>
void sum_impulses(ConstraintBlock<lanes>& block);
/// Takes impulses of the substep back but for the shares of their bodies, by row. To be called
/// after their sum.
template <std::uint32_t lanes>
void scale_impulses(ConstraintBlock<lanes>& block, ArmLanes<lanes>* arms,
                    const float* share_of_row);
/// Bodies moved with impulses of which they keep a share: notes what that changed of the sum of
/// angular momentum. Before scale_impulses(); not of split blocks.
template <std::uint32_t lanes>
void note_spin(const ConstraintBlock<lanes>& block, const ArmLanes<lanes>& arms,
               const SolverRows& bodies, const float* share_of_row, float h_s);
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
/// Strikes the contacts that close within a substep of `h_s` and rebound: all points of one at
/// once, one contact after the other (Newton's law of impact, with friction). What a strike does is
/// no part of the impulses that are kept. False if none closes; those of split blocks do not
/// rebound.
template <std::uint32_t lanes>
bool strike(ConstraintBlock<lanes>& block, ArmLanes<lanes>& arms, const SolverRows& bodies,
            float h_s);
/// What impacts need of a block.
template <std::uint32_t lanes>
struct alignas(64) ImpactLanes {
  alignas(4 * lanes) WideOf<lanes> least_m_s = {};  ///< What closes no faster is none.
  WideOf<lanes> gap_m_s[4] = {};  ///< With which a point may close within the substep, by its gap.
  WideOf<lanes> aside[9] = {};    ///< Impulses it has nothing to do with, rolling last.
};
/// A contact as a sweep of an impact wants it, which takes it from its block: rows of eight floats.
struct alignas(64) ImpactContact {
  float row[13][8] = {};
  std::uint32_t points = 0;
  bool rolls = false;
};
/// The rows of its bodies.
struct ImpactPair {
  std::int32_t row_a = 0, row_b = 0;
};
/// A sweep of what is near an impact.
struct ImpactSweep {
  std::uint8_t* moved = nullptr;  ///< By row: the last sweep that changed it; 0: none.
  std::uint8_t now = 0;
  std::uint8_t since = 0;  ///< Contacts are swept that have a body that moved since then.
};
/// Finds the gaps. Whether some point of a block, that is not split, closes as fast as impacts do.
template <std::uint32_t lanes>
bool meet(const ConstraintBlock<lanes>& block, ImpactLanes<lanes>& impact, const SolverRows& bodies,
          float inverse_h);
/// Sets impulses aside, and takes the contacts out.
template <std::uint32_t lanes>
void begin_impact(ConstraintBlock<lanes>& block, ImpactLanes<lanes>& impact, ImpactPair* pairs,
                  ImpactContact* contacts);
/// One pass as sweep_relaxed(), over those of so many contacts of one colour whose bodies moved.
/// Whether some point closed as fast as impacts do when its turn came.
template <std::uint32_t lanes>
bool pass_on(const ImpactPair* pairs, ImpactContact* contacts, std::uint32_t count,
             const SolverRows& bodies, const SoftStep& soft, const ImpactSweep& sweep);
/// Applies what the impact did, adds it to the sum of the step, and puts impulses back.
template <std::uint32_t lanes>
void end_impact(ConstraintBlock<lanes>& block, const ImpactLanes<lanes>& impact,
                ImpactContact* contacts, const SolverRows& bodies);
/// Finds the impulse on b of the step, and the work of its impulses: each times the mean of the
/// relative velocities, along its direction, at the start and at the end of the step.
template <std::uint32_t lanes>
void find_work(ConstraintBlock<lanes>& block, const SolverRows& bodies);
/// Writes the separation of every point now, by point and lane.
template <std::uint32_t lanes>
void separations_now(const ConstraintBlock<lanes>& block, const SolverRows& bodies,
                     float (*separation)[lanes]);

}  // namespace sunder::solver
