// Planned breaks: an impact and the edit that it would make to a structure. Internal to
// engine/world.
//
// A solid breaks in one of two modes: by the material's pattern, at the point of impact, or by
// stress, at the bonds that the impact overloads. Both are planned if both are possible.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/model/impact_probe.h"
#include "engine/world/actors/impact.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Prism that a fast striker sweeps, in the rest frame of the solid: the striker's cross-section
/// through the thickness of the solid. Without corners if the striker is slow or unknown.
struct SweptPrism {
  std::vector<Vec3> section_R = {};
  Vec3 point_R = Vec3::Zero(), direction_R = Vec3::UnitY();
  double thickness_m = 0;
};

/// An impact on an actor with the plans of both modes, and the mode chosen of them.
struct PlannedBreak {
  ActorImpact impact;
  std::uint32_t load = 0;               ///< Index in the loads of the probe.
  std::uint32_t striker = kNoActorKey;  ///< Key of the body that strikes.
  std::vector<std::uint32_t> riders;    ///< Keys of the bodies that strike with it as one.
  double striker_J = 0;                 ///< Work of the striker and what goes with it.
  double speed_m_s = 0;                 ///< Closing speed of the striker; 0: unknown.
  Vec3 path_m_s_W = Vec3::Zero();       ///< Velocity of the striker relative to the actor.
  Vec3 path_W = Vec3::UnitY();          ///< Unit; the striker's path through the actor.
  double time_s = 0;                    ///< Time of the impact since the start of the step.
  double impulse_Ns = 0;                ///< Sum over the contacts that load the actor.
  std::vector<AppliedForce> impulses;   ///< All impulses on the actor, N·s in place of N.
  double transmitted_J = 0;             ///< Upper bound of the energy that reaches the rest of the
                                        ///< actor; infinite for blasts, which have no striker.
  bool by_pattern = true;               ///< Strong enough to break the material.
  bool by_stress = false;               ///< Perhaps strong enough to break bonds.
  BreakCommand command;                 ///< Command of the break by pattern.
  SweptPrism swept;                     ///< Prism that the striker sweeps through the solid.
  StressResult stressed;                ///< Result of the plan by stress.
  BreakEdit edit;                       ///< Edit of the chosen mode.
  /// Bond evaluations that a plan by stress may take before it is deferred.
  std::uint64_t max_bond_evaluations = std::numeric_limits<std::uint64_t>::max();
  double plan_ms = 0;
  double needed_J = 0;    ///< Energy of the cracks, or of the plug if greater.
  double crushing_J = 0;  ///< Part of needed_J beyond the cracks.
  /// Part of needed_J that impulses along the contact normal take; sides of a slanted hole take the
  /// rest.
  double share_along_normal = 1;
  bool breaks = false;    ///< The energy of the impact suffices.
  bool at_bonds = false;  ///< The chosen mode is by stress.

  double along_normal_J() const { return share_along_normal * needed_J; }
  /// True if the break only makes plastic hinges, and no cracks.
  bool only_bends() const { return at_bonds && edit.cut.empty(); }
};

/// Returns true if the striker drives a plug out of the solid and passes through.
inline bool goes_through(const BreakCommand& command) {
  return command.plug && command.plug->through;
}

/// Returns true if an impact breaks the convex that it strikes by its pattern: if the stress of the
/// wave or the strain energy of the solid exceeds the convex's limit (docs/decisions/049).
/// `striker` is null for the ground.
bool breaks_where_struck(const WorldState& world, const Actor& actor, const ImpactLoad& load,
                         const Actor* striker);

/// Returns true if an impact at this speed shears the solid at the striker's edge before waves
/// carry the load away: v > τ / (ρ c), with the shear strength τ and c = √(E / 2.4 ρ).
bool breaks_before_waves_arrive(const Material& material, double speed_m_s);

/// Makes the break command of the impact, and the prism that its striker sweeps.
void prepare_command(const WorldState& world, const Breaker& breaker, std::uint64_t event,
                     PlannedBreak& planned);
/// Returns the approximate number of parts that the command cuts, the measure of its cost
/// (docs/decisions/032).
std::uint32_t parts_to_cut(const WorldState& world, const PlannedBreak& planned);
/// Plans prepared breaks, in parallel, without changes to the world.
void plan_all(const WorldState& world, const Breaker& breaker, std::span<PlannedBreak* const> all);

enum class Outcome {
  kHolds,      ///< The impact has too little energy for the crack.
  kBodyLimit,  ///< The limit of bodies forbids the break.
  kBreaks,
};
/// Returns the outcome of a planned break if other breaks of the step add `pieces_planned` pieces.
Outcome outcome_of(const WorldState& world, const PlannedBreak& planned,
                   std::size_t pieces_planned = 0);
/// Counts limits that were reached; after an impact that breaks nothing, raises the actor's limits
/// so that similar impacts are not planned again.
void record_outcome(WorldState& world, const PlannedBreak& planned, Outcome outcome);

/// Breaks the actor of a planned break whose energy has been taken from the motion.
void break_actor(WorldState& world, const Breaker& breaker, PlannedBreak& planned);

}  // namespace sunder
