// Stage `load`: own weight, what presses and pulls on a compound, and its spin break what they
// overload. Internal to engine/world.
//
// Read first: LoadStage::run(). What presses and pulls is averaged over a tenth of a second, so
// that a push counts alike at every length of a step; impacts are the business of stage `break`. An
// actor is judged when its load or spin has changed since it was judged last, or its bonds have.
// The breaker judges by the stress in balance with the load: nothing is worn out by time.
#pragma once

#include <cstdint>

#include "engine/model/breaker.h"
#include "engine/world/actors/world.h"

namespace sunder {

class LoadStage {
 public:
  explicit LoadStage(const Limits& limits) : work_a_frame_(limits.load_work_a_frame) {}

  /// Before the first frame: what the breaker makes of a large solid to begin with is made, as that
  /// takes longer than a frame has.
  void prepare(World& world, const Breaker& breaker) const;
  void begin_frame();
  /// After the solve.
  void run(World& world, const Breaker& breaker);
  /// Actors whose load is not judged yet.
  std::uint32_t waiting() const { return waiting_; }

 private:
  std::int64_t work_a_frame_;   ///< In visits of bonds.
  std::int64_t work_left_ = 0;  ///< Of the frame; may be owed.
  std::uint32_t waiting_ = 0;
};

}  // namespace sunder
