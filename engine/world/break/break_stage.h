// Stage `break`: what breaks, decided before the solve, so that a wall that breaks does not first
// stop the ball. Internal to engine/world.
//
// Read first: BreakStage::run(), then decide(). Break probes (break_probe.h) tell what the
// breakable solids would have to bear. A solid breaks by its pattern if the work exceeds the
// toughness times the crack's area, and the impulse the strength; and at its bonds where the blow
// overloads them. Exactly the energy of the cracks is taken from the motion; the pieces inherit the
// velocity field of the whole.
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/world/actors/impact.h"
#include "engine/world/actors/world.h"
#include "engine/world/break/break_probe.h"
#include "engine/world/break/planned_break.h"
#include "engine/world/break/waiting_room.h"

namespace sunder {

/// What a frame allows for of all that breaking takes, in parts to cut.
class BreakBudget {
 public:
  explicit BreakBudget(std::uint32_t a_frame) : a_frame_(a_frame) {}

  void begin_frame() { left_ = a_frame_, untouched_ = true; }
  bool spent() const { return left_ == 0 && !untouched_; }
  std::uint32_t left() const { return left_; }
  /// False if that is more than is left: then nothing is left for what comes later, too, however
  /// cheap. A frame that has spent none yet can afford anything, or what costs more than a frame
  /// has would wait for ever.
  bool try_spend(std::uint32_t parts);
  /// For what costs nobody knows before: what it has cost is not there for what comes later.
  void charge(std::uint64_t parts) {
    left_ -= static_cast<std::uint32_t>(std::min<std::uint64_t>(left_, parts));
  }

 private:
  std::uint32_t a_frame_;
  std::uint32_t left_ = 0;
  bool untouched_ = true;  ///< Nothing has been taken on yet.
};

/// A probe under way.
struct Trial {
  BreakProbe probe;
  std::uint64_t fingerprint = 0;  ///< Of the probe as it began; 0: not known yet.
  bool asked = false;             ///< What it has to bear is known, but not decided.
  std::uint64_t charged = 0;      ///< Of the probe's work.
  std::vector<ProbeLoad> loads = {};
  std::vector<PlannedBreak> planned = {};
  bool may_wait = false;  ///< Until what its impacts break is known, or the frame has room for it.
};

class BreakStage {
 public:
  explicit BreakStage(const Limits& limits) : budget_(limits.parts_a_frame) {}

  void begin_frame() { budget_.begin_frame(); }
  /// Breaks what `impacts` of blasts, and what approaches, can break; contacts are found anew after
  /// every round of breaks.
  void run(World& world, const Breaker& breaker, std::span<const Impact> impacts);
  /// Impacts that wait for a later step's budget.
  std::uint32_t waiting() const;

 private:
  void ask(World& world, std::vector<Trial>& trials);
  /// Energy that an impact must have to be looked at: none while the frame's budget lasts.
  double least_worth_J(const World& world) const;
  /// Makes impacts ready to be planned, and spends what they cost; false if that is too much.
  bool take_on(World& world, const Breaker& breaker, std::span<PlannedBreak> all);
  /// Shares what is left of the frame among plans by stress: those that may go on in the next
  /// frame.
  void share_out(std::span<PlannedBreak* const> resumable) const;
  /// Stops the bodies of a trial until the next step, in which it is found anew.
  void wait(World& world, Trial& trial);
  /// Impacts that come with an energy of their own; true if something broke.
  bool break_by_blasts(World& world, const Breaker& breaker, std::span<const Impact> impacts);
  /// Follows all probes until each has broken something or come to the end of the step, or has to
  /// wait (if it is not `in_time`, or too costly); true if another round is due. What another trial
  /// has broken meanwhile is hit again in that round, as what became of it.
  bool decide(World& world, const Breaker& breaker, std::vector<Trial> trials, bool in_time);

  BreakBudget budget_;
  std::set<std::uint64_t> held_;         ///< Fingerprints of probes of this step in which all held.
  std::vector<Impact> impacts_waiting_;  ///< Over the frame's budget: decided first in the next.
  WaitingRoom waiting_room_;
};

}  // namespace sunder
