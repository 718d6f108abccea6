// An impact, and what it would do: planned, but not carried out. Internal to engine/world.
//
// There are two ways to break: by the material's pattern, where the impact lands, and by stress,
// where the impact overloads bonds. Both are planned where both may be.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/world/actors/impact.h"
#include "engine/world/actors/world.h"
#include "engine/world/break/break_probe.h"

namespace sunder {

/// The prism that a fast striker sweeps, in the rest frame of the solid: the striker's
/// cross-section through the thickness of the solid. It has no corners if the striker is slow or
/// unknown.
struct StrikersWay {
  std::vector<Vec3> section_R = {};
  Vec3 point_R = Vec3::Zero(), direction_R = Vec3::UnitY();
  double thickness_m = 0;
};

struct PlannedBreak {
  Impact impact;
  std::uint32_t load = 0;              ///< Index in the probe's answer.
  std::uint32_t striker = kNobodyKey;  ///< Key of the body that strikes.
  double speed_m_s = 0;                ///< Closing speed of the striker; 0: not known.
  double impulse_Ns = 0;               ///< Sum over the contacts that load the actor.
  std::vector<Load> impulses;          ///< All that the actor feels, N·s in place of N.
  double far_J = 0;                    ///< Energy that gets through to the rest, at most; of a
                                       ///< blast infinite, as nothing strikes.
  bool by_pattern = true;              ///< Strong enough for the material,
  bool by_stress = false;              ///< and for some bond.
  BreakCommand command;                ///< By pattern.
  StrikersWay way;                     ///< Through the solid.
  StressAnswer stressed;               ///< By stress.
  BreakEdit edit;                      ///< Of the way that it breaks.
  /// Of bonds, that a plan by stress may take before it is put off.
  std::uint64_t most_visits = std::numeric_limits<std::uint64_t>::max();
  double plan_ms = 0;
  double needed_J = 0;    ///< By its cracks, or by the plug if that takes more,
  double crushing_J = 0;  ///< which is this much more.
  bool breaks = false;    ///< The impact pays for them.
  bool at_bonds = false;  ///< By stress.

  /// Effective mass of what strikes, from the work that it can do.
  double striker_kg() const { return 2 * impact.energy_J / (speed_m_s * speed_m_s); }
  /// It parts at hinges and cracks nowhere.
  bool only_bends() const { return at_bonds && edit.cut.empty(); }
};

/// Returns true if an impact breaks the convex that it strikes by its pattern: if the stress of the
/// wave or the strain energy of the whole exceeds the convex's limit (docs/decisions/049).
/// `striker` is null for the ground.
bool breaks_where_struck(const World& world, const Actor& actor, const ProbeLoad& load,
                         const Actor* striker);

/// True if an impact at that speed shears the solid at the striker's edge before waves have carried
/// the load away: v > τ / (ρ c), with the shear strength τ and c = √(E / 2.4 ρ).
bool breaks_before_waves_arrive(const Material& material, double speed_m_s);

/// Makes the command that the impact amounts to.
void prepare(const World& world, const Breaker& breaker, std::uint64_t event,
             PlannedBreak& planned);
/// How many parts its command cuts, about: what it costs follows that (docs/decisions/032).
std::uint32_t parts_to_cut(const World& world, const PlannedBreak& planned);
/// Plans what is prepared, in parallel; nothing changes yet.
void plan_all(const World& world, const Breaker& breaker, std::span<PlannedBreak* const> all);

enum class Verdict {
  kHolds,   ///< The impact does not pay for the crack.
  kNoRoom,  ///< The limit of bodies forbids it.
  kBreaks,
};
/// With so many pieces of others to come.
Verdict verdict_on(const World& world, const PlannedBreak& planned, std::size_t to_come = 0);
/// Remembers what an impact lacked, if it did.
void note_verdict(World& world, const PlannedBreak& planned, Verdict verdict);

/// Breaks the actor of an impact that has paid for it.
void break_actor(World& world, const Breaker& breaker, PlannedBreak& planned);

}  // namespace sunder
