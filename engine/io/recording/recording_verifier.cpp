#include "engine/io/recording/recording_verifier.h"

#include <algorithm>

#include "engine/io/recording/frame_coder.h"
#include "engine/io/state_hash.h"

namespace sunder {
namespace {

/// Returns a description of the first body that differs; both lists ascend by key.
std::string first_difference(const Frame& now, const Frame& then,
                             const std::vector<std::int32_t>& hashes_then) {
  for (std::size_t b = 0; b < std::max(now.bodies.size(), then.bodies.size()); ++b) {
    if (b == now.bodies.size() ||
        (b < then.bodies.size() && then.bodies[b].key < now.bodies[b].key)) {
      return "body " + std::to_string(then.bodies[b].key) + " is only in the recording";
    }
    const std::string body = "body " + std::to_string(now.bodies[b].key);
    if (b == then.bodies.size() || now.bodies[b].key < then.bodies[b].key) {
      return body + " is not in the recording";
    }
    if (short_hash(now.bodies[b]) != hashes_then[b]) {
      const double apart_m = (now.bodies[b].X_WB.position - then.bodies[b].X_WB.position).norm();
      return body + " differs, by " + std::to_string(apart_m) + " m in position";
    }
  }
  return "all bodies are equal, but debris or dust differs";
}

}  // namespace

void RecordingVerifier::take(const FramePtr& frame) {
  if (!difference_.empty()) return;
  const std::string name = "frame " + std::to_string(frame->index) + ": ";
  FramePtr then = take_.next();
  while (same_ == 0 && then && then->index < frame->index) then = take_.next();
  if (!then) {
    difference_ = name + (take_.damage().empty() ? "the recording has ended" : take_.damage());
  } else if (then->index != frame->index) {
    difference_ =
        name + "the recording has frame " + std::to_string(then->index) + " at this position";
  } else if (hash_state(*then) != hash_state(*frame)) {
    difference_ = name + first_difference(*frame, *then, take_.body_hashes());
  } else {
    ++same_;
  }
}

}  // namespace sunder
