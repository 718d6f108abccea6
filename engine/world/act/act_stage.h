// Stage `act`: what the script does to the world at this time; and making room when it is full.
// Internal to engine/world.
//
// Read first: ActStage::run() and push(). Acts come before contacts are found, pushes after breaks
// were decided, so that what a blast breaks off is what it blows away.
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
  /// Brings in, takes away, moves on and lights what is due; when bodies are too many, the smallest
  /// at rest become debris. The answer is what blasts do to what they might break now.
  std::vector<Impact> run(World& world);
  /// After breaks: what blasts and drives push.
  void push(World& world);

  /// Whether a blast still breaks, and has yet to push what it broke.
  bool blasts() const { return !bursts_.empty(); }

  std::span<const Shot> shots_to_come(const Scene& scene) const;

 private:
  std::size_t next_shot_ = 0, next_removal_ = 0, next_blast_ = 0;
  std::vector<Burst> bursts_;
};

}  // namespace sunder
