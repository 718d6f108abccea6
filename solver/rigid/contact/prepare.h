// Conversion between manifolds and constraint blocks.
#pragma once

#include <span>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/sweep.h"
#include "solver/rigid/contact/mass_splitting.h"
#include "solver/rigid/contact/sweep_order.h"

namespace sunder::solver {

/// Input of the blocks of a step, and the rows that they change.
struct ContactStep {
  const StepContext& context;
  const Bodies& bodies;
  Contacts& contacts;
  std::span<const ManifoldSlot> manifolds;  ///< Manifolds to solve, in the order of blocks.
  std::uint32_t first_split;                ///< Index of the first split manifold.
  std::span<const SplitSides> split;        ///< Sides of the split manifolds.
  SpanByBody<const Mat3f> root_W;           ///< Roots of awake and kinematic bodies.
  SolverRows rows;
  SoftStep soft;
  float rebound_m_s;  ///< Closing speed below which a contact does not rebound.
  SpanByBody<const std::uint32_t> deep_contacts = {};  ///< By body; empty: there are none.
  /// Number of loaded manifolds by body, at most kPinchedContacts.
  SpanByBody<const std::uint8_t> loaded_contacts = {};
  /// Rows of moving kinematic bodies, below 0; 0 for other bodies. Empty: there are none.
  SpanByBody<const std::int32_t> kinematic_rows = {};

  std::int32_t row(BodySlot body) const {
    if (bodies.awake(body)) return static_cast<std::int32_t>(row_of(body));
    return kinematic_rows.empty() ? 0 : kinematic_rows[body];
  }
};

/// Sets all of a block except `first`, `count` and `split`, which select its manifolds; and its
/// `arms`, if they are to follow the bodies.
template <std::uint32_t lanes>
void prepare_block(const ContactStep& step, ConstraintBlock<lanes>& block,
                   ArmLanes<lanes>* arms = nullptr);

/// Sets the minimum closing speed of an impact for each lane.
template <std::uint32_t lanes>
void prepare_impact(const ContactStep& step, const ConstraintBlock<lanes>& block,
                    ImpactLanes<lanes>& impact);

/// Stores impulses and final separations in the manifolds, and marks friction anchors that slipped.
template <std::uint32_t lanes>
void store_block(const ContactStep& step, const ConstraintBlock<lanes>& block);

}  // namespace sunder::solver
