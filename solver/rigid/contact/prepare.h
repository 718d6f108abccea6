// From manifolds to constraint blocks, and back.
#pragma once

#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/sweep.h"
#include "solver/rigid/contact/mass_splitting.h"
#include "solver/rigid/contact/sweep_order.h"

namespace sunder::solver {

/// What the blocks of a step are made from, and what they work on.
struct ContactStep {
  const StepContext& context;
  const Bodies& bodies;
  Contacts& contacts;
  std::span<const ManifoldSlot> manifolds;  ///< To solve, in the order of blocks.
  std::uint32_t first_split;                ///< Manifolds from here on are split,
  std::span<const SplitSides> split;        ///< as this says of each.
  SpanByBody<const Mat3f> root_W;           ///< Of those awake, and of kinematic ones.
  SolverRows rows;
  SoftStep soft;
  float rebound_m_s;                                    ///< Slower impacts do not rebound.
  SpanByBody<const std::uint32_t> deep_contacts = {};   ///< Empty: there are none.
  SpanByBody<const std::uint8_t> loaded_contacts = {};  ///< Loaded manifolds, up to kPinched.
  /// Of kinematic bodies on their way, below 0; of others 0. Empty: there are none.
  SpanByBody<const std::int32_t> kinematic_rows = {};

  std::int32_t row(BodySlot body) const {
    if (bodies.awake(body)) return static_cast<std::int32_t>(row_of(body));
    return kinematic_rows.empty() ? 0 : kinematic_rows[body];
  }
};

/// Fills everything but `first`, `count` and `split`, which say what goes in; and `arms`,
/// if they are to follow the bodies.
template <std::uint32_t lanes>
void prepare_block(const ContactStep& step, ConstraintBlock<lanes>& block,
                   ArmLanes<lanes>* arms = nullptr);

/// Says of every lane what is no impact.
template <std::uint32_t lanes>
void prepare_impact(const ContactStep& step, const ConstraintBlock<lanes>& block,
                    ImpactLanes<lanes>& impact);

/// Hands impulses and final separations back to the manifolds, and lets friction anchors go where
/// the patch slid.
template <std::uint32_t lanes>
void store_block(const ContactStep& step, const ConstraintBlock<lanes>& block);

}  // namespace sunder::solver
