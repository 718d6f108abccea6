// Kernels: operations on one block of manifolds and its bodies, for 1, 4, 8 and 16 lanes
// (sweep_1.cpp and so on, each compiled for its instruction set). Read first: sweep() in
// sweep_kernels.h.
#pragma once

#include "solver/rigid/contact/kernels/constraint_block.h"

namespace sunder::solver {

/// Rows that the kernels change, by body slot + 1; row 0 is immovable.
struct SolverRows {
  BodyRow* rows = nullptr;
  Wide* parts = nullptr;  ///< Changes of bodies by split manifolds, to be summed.
  Wide* spins = nullptr;  ///< Angular momentum (root space) to be added at the end of the step.
};

/// Fraction of a substep, or of the size of a contact, that is negligible.
inline constexpr float kNegligible = 0.01f;

/// Lever arms of a block's impulses, which follow the bodies within a step. An impulse and its
/// counterpart act at one point, on the body whose corners touch the other's face; otherwise the
/// pair would change the total angular momentum by the motion of the bodies past each other.
template <std::uint32_t lanes>
struct alignas(64) ArmLanes {
  /// Columns; zero for a side that takes no impulse.
  alignas(4 * lanes) Wide3Of<lanes> root_a[3] = {};
  Wide3Of<lanes> root_b[3] = {};
  /// Fraction of the gap that the arms of a close; those of b close the rest.
  WideOf<lanes> share_a = {};
  WideOf<lanes> least = {};  ///< Squared change of the gap below which arms are kept.
  WideOf<lanes> wide = {};   ///< Squared gap that no body spans; 0 for balls, which would spin.
  WideOf<lanes> near = {};   ///< Squared distance along the normal that is negligible.
  Wide3Of<lanes> gap = {};   ///< From a's friction point to b's at the start of the step.
  Wide3Of<lanes> closed_gap = {};
  Wide3Of<lanes> moving_impulse = {};  ///< Impulse on b with which the bodies last moved.
  /// Change of angular momentum by impulses with the new arms, to be applied.
  Wide3Of<lanes> pending_a = {}, pending_b = {};
  bool has_pending = false;
};

/// Input of a block, besides the block's own data.
template <std::uint32_t lanes>
struct alignas(64) GatheredBlock {
  Wide3Of<lanes> root_a[3] = {}, root_b[3] = {};  ///< Columns.
  Wide3Of<lanes> drift = {}, friction_impulse = {}, friction_arm_a = {}, friction_arm_b = {};
  Wide3Of<lanes> roll_impulse = {};
  Wide3Of<lanes> arm_a[4] = {}, arm_b[4] = {};
  Wide3Of<lanes> offset = {};  ///< Centre of b minus centre of a.
  WideOf<lanes> share_a = {};  ///< As in ArmLanes.
  Wide3Of<lanes> gap = {}, closed_gap = {};
  WideOf<lanes> closes_gap = {};         ///< 1: the arms close the gap from the start.
  Wide3Of<lanes> gravity = {};           ///< Acceleration of b minus that of a.
  WideOf<lanes> has[4] = {};             ///< 1: the manifold has the point.
  WideOf<lanes> normal_mass_scale = {};  ///< Scales of the normal spring.
  WideOf<lanes> normal_impulse_scale = {};
  /// Compliance of the normal springs over that without load.
  WideOf<lanes> compliance_scale = {};
  WideOf<lanes> awake_a = {}, awake_b = {};  ///< 1: awake or kinematic.
  WideOf<lanes> parts_a = {}, parts_b = {};  ///< Number of parts of the body in a split block.
  bool sleepers = false;
};

/// Computes Jacobians and effective masses.
template <std::uint32_t lanes>
void derive(GatheredBlock<lanes>& gathered, ConstraintBlock<lanes>& block);
/// Updates Jacobians and effective masses after the bodies moved. The arms follow the bodies or,
/// where these are far from each other, point to where they will touch within a substep of `h_s`.
/// Impulses of this substep keep the effect that they had with the old arms; the difference is
/// applied in the next substep.
template <std::uint32_t lanes>
void update_arms(ConstraintBlock<lanes>& block, ArmLanes<lanes>& arms, const SolverRows& bodies,
                 float h_s);
/// Applies the difference that update_arms() left, after a substep began with the impulses of the
/// last one.
template <std::uint32_t lanes>
void apply_arm_change(ConstraintBlock<lanes>& block, ArmLanes<lanes>& arms,
                      const SolverRows& bodies);
/// Applies the impulses of the last step.
template <std::uint32_t lanes>
void warm_start(ConstraintBlock<lanes>& block, const SolverRows& bodies);
/// One Gauss-Seidel pass with soft bias, which corrects overlaps.
template <std::uint32_t lanes>
void sweep_biased(ConstraintBlock<lanes>& block, const SolverRows& bodies, const SoftStep& soft);
/// One pass without bias, which removes the velocity added by the correction.
template <std::uint32_t lanes>
void sweep_relaxed(ConstraintBlock<lanes>& block, const SolverRows& bodies, const SoftStep& soft);
/// Adds the impulses of a substep to those of the step.
template <std::uint32_t lanes>
void sum_impulses(ConstraintBlock<lanes>& block);
/// Scales the impulses of the substep by the scale of their bodies, by row. Must be called after
/// sum_impulses().
template <std::uint32_t lanes>
void scale_impulses(ConstraintBlock<lanes>& block, ArmLanes<lanes>* arms,
                    const float* scale_of_row);
/// Records the change of the total angular momentum when impulses are scaled with which bodies have
/// moved. Must be called before scale_impulses(); has no effect on split blocks.
template <std::uint32_t lanes>
void record_spin_change(const ConstraintBlock<lanes>& block, const ArmLanes<lanes>& arms,
                        const SolverRows& bodies, const float* scale_of_row, float h_s);
/// State of conjugate gradients by impulse: points, friction, twist.
template <std::uint32_t lanes>
struct alignas(64) SearchLanes {
  alignas(4 * lanes) WideOf<lanes> start[7] = {};  ///< Impulses before the sweep.
  WideOf<lanes> direction[7] = {};                 ///< Direction of the last step.
};
/// Stores the impulses before a sweep.
template <std::uint32_t lanes>
void save_impulses(const ConstraintBlock<lanes>& block, SearchLanes<lanes>& search);
/// Writes the energy of a sweep's changes, by lane.
template <std::uint32_t lanes>
void find_change_energy(const ConstraintBlock<lanes>& block, const SearchLanes<lanes>& search,
                        float* energy);
/// Steps along the search direction after a sweep: `beta` times the last step; 0 restarts the
/// search.
template <std::uint32_t lanes>
void step_along_direction(ConstraintBlock<lanes>& block, SearchLanes<lanes>& search,
                          const SolverRows& bodies, float beta);
/// Applies restitution to contacts that touch within a substep of `h_s` and rebound: all points of
/// a contact at once, one contact after another (Newton's law of impact, with friction). Its
/// impulses do not warm start later substeps. Returns false if no contact rebounds; split blocks
/// have no restitution.
template <std::uint32_t lanes>
bool apply_restitution(ConstraintBlock<lanes>& block, ArmLanes<lanes>& arms,
                       const SolverRows& bodies, float h_s);
/// State of a block near an impact.
template <std::uint32_t lanes>
struct alignas(64) ImpactLanes {
  alignas(4 * lanes) WideOf<lanes> least_m_s = {};  ///< Minimum closing speed of an impact.
  /// Closing speed at which a point's gap closes within the substep.
  WideOf<lanes> gap_m_s[4] = {};
  WideOf<lanes> saved[9] = {};  ///< Impulses stored during the propagation, rolling last.
};
/// Data of a contact in a sweep of an impact, extracted from its block: rows of eight floats.
struct alignas(64) ImpactContact {
  float row[13][8] = {};
  std::uint32_t points = 0;
  bool rolls = false;
};
/// Rows of the contact's bodies.
struct ImpactPair {
  std::int32_t row_a = 0, row_b = 0;
};
/// State of the sweeps near an impact.
struct ImpactSweep {
  std::uint8_t* moved = nullptr;  ///< By row: the last sweep that changed it; 0: none.
  std::uint8_t now = 0;
  std::uint8_t since = 0;  ///< Contacts are swept with a body that moved in this sweep or later.
};
/// Finds the gaps of a block that is not split; returns true if a point closes as fast as an
/// impact.
template <std::uint32_t lanes>
bool find_gaps(const ConstraintBlock<lanes>& block, ImpactLanes<lanes>& impact,
               const SolverRows& bodies, float inverse_h);
/// Stores the impulses and extracts the contacts.
template <std::uint32_t lanes>
void extract_contacts(ConstraintBlock<lanes>& block, ImpactLanes<lanes>& impact, ImpactPair* pairs,
                      ImpactContact* contacts);
/// One pass like sweep_relaxed() over those of `count` contacts of one colour whose bodies moved.
/// Returns true if a point closed as fast as an impact when its turn came.
template <std::uint32_t lanes>
bool propagate(const ImpactPair* pairs, ImpactContact* contacts, std::uint32_t count,
               const SolverRows& bodies, const SoftStep& soft, const ImpactSweep& sweep);
/// Applies the impulses of the propagation, adds them to the sum of the step, and restores the
/// stored ones.
template <std::uint32_t lanes>
void apply_propagation(ConstraintBlock<lanes>& block, const ImpactLanes<lanes>& impact,
                       ImpactContact* contacts, const SolverRows& bodies);
/// Finds the impulse on b over the step, and the work of each impulse: the impulse times the mean
/// of the relative velocities, along its direction, at the start and at the end of the step.
template <std::uint32_t lanes>
void find_work(ConstraintBlock<lanes>& block, const SolverRows& bodies);
/// Writes the current separation of each point, by point and lane.
template <std::uint32_t lanes>
void separations_now(const ConstraintBlock<lanes>& block, const SolverRows& bodies,
                     float (*separation)[lanes]);

}  // namespace sunder::solver
