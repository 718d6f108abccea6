// Matching of the contents of two successive frames, and interpolation between them.
//
// Bodies are matched by key, and pieces with the body they came off: both share its rest frame,
// which gives the pose of a piece before the break. Debris and dust have no keys: they keep their
// order in a frame except for added and removed ones, and are matched by their properties.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

inline constexpr std::uint32_t kNoMatch = 0xffffffff;

/// Index in the previous frame of each body, chip and puff of a frame, or kNoMatch.
struct FrameMatch {
  std::vector<std::uint32_t> bodies, debris, dust;
};
/// Matches the contents of frame `after` with those of the previous frame `before`.
FrameMatch passage(const Frame& before, const Frame& after);

/// Two successive frames with their matching, and optionally the frame after them.
struct FrameInterval {
  FramePtr before, after;
  FrameMatch after_match;           ///< Matches `after` with `before`.
  FramePtr beyond = nullptr;        ///< Frame after `after`, or null.
  FrameMatch following_match = {};  ///< Matches `beyond` with `after`.
};

/// Returns the interval from `before` to `after`. If `before` is null, the bodies of `after` are
/// moved back by their velocities in its place. The frames must outlive the interval.
FrameInterval up_to(const Frame& after, const Frame* before);

/// Interpolates between the two frames at `part` (0 to 1). Bodies move along straight lines and
/// turn at constant rates. A body that breaks moves as a whole until the time of the break; then
/// its pieces move to their final poses. New bodies are extrapolated backwards, removed ones
/// forwards. New debris and dust grow from their points of emission, removed ones shrink.
std::shared_ptr<Frame> between(const FrameInterval& interval, double part);

}  // namespace sunder::render
