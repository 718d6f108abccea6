// Stage `break`: impacts break solids before the solve, so that a wall that breaks does not first
// stop the ball. Internal to engine/world.
//
// Read first: BreakStage::run(), then resolve(). Impact probes (impact_probe.h) find the impact
// loads on breakable solids. A solid breaks by its pattern if the work exceeds the toughness times
// the crack's area, and the impulse the strength; and at the bonds that the impact overloads.
// Exactly the energy of the cracks is taken from the motion; the pieces inherit the velocity field
// of the solid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/model/impact_probe.h"
#include "engine/world/actors/impact.h"
#include "engine/world/actors/world_state.h"
#include "engine/world/break/deferred_impacts.h"
#include "engine/world/break/planned_break.h"

namespace sunder {

/// Budget of a frame for breaking, in parts to cut.
class BreakBudget {
 public:
  explicit BreakBudget(std::uint32_t a_frame) : a_frame_(a_frame) {}

  /// `share` is the length of the frame, in sixtieths of a second.
  void begin_frame(double share = 1) {
    left_ = static_cast<std::uint32_t>(std::lround(share * a_frame_));
    untouched_ = true;
  }
  bool spent() const { return left_ == 0 && !untouched_; }
  std::uint32_t left() const { return left_; }
  /// Spends `parts`; returns false, and empties the budget, if less is left. The first spending of
  /// a frame always succeeds: otherwise a break that costs more than a frame's budget would be
  /// deferred for ever.
  bool try_spend(std::uint32_t parts);
  /// Spends up to `parts` for work whose cost was not known before it was done.
  void charge(std::uint64_t parts) {
    left_ -= static_cast<std::uint32_t>(std::min<std::uint64_t>(left_, parts));
  }

  static auto fields(auto& self) { return std::tie(self.a_frame_, self.left_, self.untouched_); }

 private:
  std::uint32_t a_frame_;
  std::uint32_t left_ = 0;
  bool untouched_ = true;  ///< No call of try_spend() has succeeded yet.
};

/// A probe in progress, with its loads and planned breaks.
struct Trial {
  std::unique_ptr<ImpactProbe> probe;
  std::uint64_t fingerprint = 0;  ///< Hash of the probe's initial state; 0: not computed yet.
  bool loads_known = false;       ///< `loads` are those of the current event.
  std::uint64_t charged = 0;      ///< Work of the probe charged to the budget so far.
  std::vector<ImpactLoad> loads = {};
  std::vector<PlannedBreak> planned = {};
  bool may_defer = false;  ///< The trial may be deferred to the next step.
};

class BreakStage {
 public:
  explicit BreakStage(const Limits& limits) : budget_(limits.parts_a_frame) {}

  /// `share` is the length of the frame, in sixtieths of a second.
  void begin_frame(double share) { budget_.begin_frame(share); }
  /// Breaks the solids that `impacts` of blasts and speculative contacts can break. Contacts are
  /// found anew after every round of breaks.
  void run(WorldState& world, const Breaker& breaker, std::span<const ActorImpact> impacts);
  /// Number of deferred blast impacts and clusters.
  std::uint32_t deferred() const;

  static auto fields(auto& self) {
    return std::tie(self.budget_, self.unbroken_probes_, self.deferred_blast_impacts_,
                    self.deferred_impacts_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const WorldState& world) const;

 private:
  /// Advances the probes without known loads to their next loads; removes trials without any.
  void run_probes(WorldState& world, std::vector<Trial>& trials);
  /// Least energy of an impact that is probed: 0 while the frame's budget lasts.
  double min_impact_energy_J(const WorldState& world) const;
  /// Prepares impacts for planning and spends their cost; false if the budget does not suffice.
  bool prepare_within_budget(WorldState& world, const Breaker& breaker,
                             std::span<PlannedBreak> all);
  /// Shares the rest of the budget among the plans by stress that may be resumed in the next frame.
  void share_budget(std::span<PlannedBreak* const> resumable) const;
  /// Pauses the bodies of a trial until the next step, in which a new probe is made of them.
  void defer(WorldState& world, Trial& trial);
  /// Breaks solids by the impacts of blasts; returns true if something broke.
  bool break_by_blasts(WorldState& world, const Breaker& breaker,
                       std::span<const ActorImpact> impacts);
  /// Advances each probe until it breaks something, reaches the end of the step, or is deferred (if
  /// no `rounds_left`, or over the budget). Returns true if another round is due, in which solids
  /// that another trial has broken meanwhile are probed as their pieces.
  bool resolve(WorldState& world, const Breaker& breaker, std::vector<Trial> trials,
               bool rounds_left);

  BreakBudget budget_;
  /// Fingerprints of this step's probes without a break.
  std::set<std::uint64_t> unbroken_probes_;
  std::vector<ActorImpact>
      deferred_blast_impacts_;  ///< Over the frame's budget: first in the next.
  DeferredImpacts deferred_impacts_;
};

}  // namespace sunder
