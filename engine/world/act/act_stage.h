// Stage `act`: carries out actions that are due, of the scene's script and of the program that runs
// the world, and reduces the number of bodies near its limit.
// Internal to engine/world.
//
// Read first: ActStage::run() and push(). Actions come before contacts are found, impulses after
// breaks, so that a blast's impulse acts on the pieces it has broken off.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/world/act/agenda.h"
#include "engine/world/act/blast.h"
#include "engine/world/act/moves.h"
#include "engine/world/actors/impact.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Removes an actor, and its joints.
void remove_actor(WorldState& world, std::uint32_t key);
/// Removes all anchors of an actor, which is then replaced by a new one.
void loosen_actor(WorldState& world, std::uint32_t key);

class ActStage {
 public:
  /// Adds the script of the world's scene, and makes bodies with moves kinematic.
  void start(WorldState& world);
  // Actions to carry out at their time, or in the next step if that has passed.
  void add(WorldState& world, Shot shot);
  void add(Blast blast) { blasts_to_come_.add({blast.time_s, next_blast_++, std::move(blast)}); }
  void add(Removal removal) { removals_.add(std::move(removal)); }
  void add(Drive drive) { drives_.push_back(std::move(drive)); }
  /// Begins a move of a body at its current pose.
  void add(WorldState& world, const Move& move, const Actor& actor);
  void end_move(std::uint32_t key) { moves_.end(key); }
  /// Adds an impact without a striker, for the next step.
  void add(ActorImpact impact);

  /// Carries out shots, removals, moves and blasts that are due; near the limit of bodies the
  /// smallest fragments at rest become debris. Returns the impacts of blasts on actors that they
  /// may break.
  std::vector<ActorImpact> run(WorldState& world);
  /// Applies the impulses of blasts and drives, after breaks.
  void push(WorldState& world);

  /// True if a blast has not applied its impulse yet.
  bool has_blast_impulse() const { return !blasts_.empty(); }

  /// Mass of the shots to come.
  double mass_to_come_kg() const;

  static auto fields(auto& self) {
    return std::tie(self.shots_, self.blasts_to_come_, self.removals_, self.drives_, self.moves_,
                    self.blasts_, self.impacts_, self.next_blast_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const WorldState& world) const;

 private:
  struct PlannedShot {
    double time_s = 0;
    double mass_kg = 0;  ///< Of the ball and its chain.
    std::uint32_t name = kNoName;
    Shot shot;
  };
  struct PlannedBlast {
    double time_s = 0;
    std::uint32_t number = 0;
    Blast blast;
  };
  Agenda<PlannedShot> shots_;
  Agenda<PlannedBlast> blasts_to_come_;
  Agenda<Removal> removals_;
  std::vector<Drive> drives_;
  Moves moves_;
  std::vector<ActiveBlast> blasts_;
  std::vector<ActorImpact> impacts_;  ///< Of the program, for the next step.
  std::uint32_t next_blast_ = 0;      ///< Number of the next blast, or impact of the program.
};

}  // namespace sunder
