// What `sunder bench` timed, as a page.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::app {

/// Keeps the time of every stage of the frames it takes, but the first, which is no simulated time.
class StageTimes final : public FrameSink {
 public:
  using Stages = std::array<double, kStages>;  ///< Milliseconds.

  void take(const FramePtr& frame) override;
  const std::vector<Stages>& frames() const { return frames_; }

 private:
  std::vector<Stages> frames_;
};

struct TimedScene {
  std::string name;
  std::vector<StageTimes::Stages> frames;
};

/// Of each scene how its stages go on in time, and how many of its frames take how long.
std::string bench_page(std::span<const TimedScene> scenes);

}  // namespace sunder::app
