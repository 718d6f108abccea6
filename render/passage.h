// From one frame to the next: what became of what, and how things stand between the two.
//
// Bodies are known by their keys, and pieces by what they came off: they lie in its rest frame, so
// where a piece was before the break is known. Debris and dust have no keys: they keep their places
// in a frame but for those that come and go, and are known again by what they look like.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

inline constexpr std::uint32_t kNotThere = 0xffffffff;

/// For bodies, debris and dust of a frame: their numbers in the frame before, or kNotThere.
struct Passage {
  std::vector<std::uint32_t> bodies, debris, dust;
};
Passage passage(const Frame& before, const Frame& after);

/// Two frames, and what is known of the one behind them, if there is one.
struct Interval {
  FramePtr before, after;
  Passage into_after;
  FramePtr beyond = nullptr;
  Passage into_beyond = {};
};

/// Up to a frame: from the one before or, where there is none, as if all had moved evenly. What is
/// given has to outlive it.
Interval up_to(const Frame& after, const Frame* before);

/// The instant `part` (0 to 1) of the way from one frame to the other. Bodies go straight and turn
/// evenly. What breaks on the way comes apart at that time: until then its pieces are where they
/// were in the whole, and then they move to where they are after. A shot comes from where it flew.
/// What is gone afterwards flies on as it did; debris and dust grow into view, from where they fly
/// away from, and shrink out of it.
std::shared_ptr<Frame> between(const Interval& interval, double part);

}  // namespace sunder::render
