// A hash of everything simulated: two runs are the same iff their hashes are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/frame.h"

namespace sunder {

/// Folds the bodies of every frame it takes (key, pose, velocities, sleep) into one xxhash.
class StateHash final : public FrameSink {
 public:
  StateHash();
  ~StateHash() override;
  void take(const FramePtr& frame) override;
  /// 16 hexadecimal digits, over all frames so far.
  std::string hex() const;
  /// One per frame taken, each over that frame alone.
  const std::vector<std::uint64_t>& per_frame() const { return per_frame_; }

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<std::uint64_t> per_frame_;
};

}  // namespace sunder
