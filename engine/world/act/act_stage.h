// Stage `act`: carries out the scene's script, and reduces the number of bodies near its limit.
// Internal to engine/world.
//
// Read first: ActStage::run() and push(). Actions come before contacts are found, impulses after
// breaks, so that a blast's impulse acts on the pieces it has broken off.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/world/act/blast.h"
#include "engine/world/actors/impact.h"
#include "engine/world/actors/world.h"

namespace sunder {

class ActStage {
 public:
  /// Carries out shots, removals, moves and blasts that are due; near the limit of bodies the
  /// smallest fragments at rest become debris. Returns the impacts of blasts on actors that they
  /// may break.
  std::vector<ActorImpact> run(World& world);
  /// Applies the impulses of blasts and drives, after breaks.
  void push(World& world);

  /// True if a blast has not applied its impulse yet.
  bool has_blast_impulse() const { return !blasts_.empty(); }

  std::span<const Shot> shots_to_come(const Scene& scene) const;

 private:
  std::size_t next_shot_ = 0, next_removal_ = 0, next_blast_ = 0;
  std::vector<ActiveBlast> blasts_;
};

}  // namespace sunder
