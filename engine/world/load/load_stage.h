// Stage `load`: self-weight, contact forces, joints and spin break the bonds that they overload.
// Internal to engine/world.
//
// Read first: LoadStage::run(). Forces are averaged over a tenth of a second, so that a short force
// counts alike at every length of a step; impacts belong to stage `break`. The stress of an actor
// is computed when its load, spin or bonds have changed since the last time. The breaker decides by
// the stress in equilibrium with the load: there is no fatigue.
#pragma once

#include <cstdint>
#include <tuple>

#include "engine/model/breaker.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

class LoadStage {
 public:
  explicit LoadStage(const Limits& limits) : work_a_frame_(limits.load_work_a_frame) {}

  /// Makes the stress systems of large solids before the first frame, as that takes longer than a
  /// frame has.
  void prepare(WorldState& world, const Breaker& breaker) const;
  /// `share` is the length of the frame, in sixtieths of a second.
  void begin_frame(double share);
  /// Runs the stage after the solve.
  void run(WorldState& world, const Breaker& breaker);
  /// Number of actors whose load is not evaluated yet.
  std::uint32_t deferred() const { return deferred_; }

  static auto fields(auto& self) {
    return std::tie(self.work_a_frame_, self.work_left_, self.deferred_);
  }

 private:
  std::int64_t work_a_frame_;   ///< In bond evaluations.
  std::int64_t work_left_ = 0;  ///< Rest of the frame's work; may be negative.
  std::uint32_t deferred_ = 0;
};

}  // namespace sunder
