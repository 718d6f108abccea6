// Times of drawing, beside the stages of a run.
#pragma once

#include <optional>
#include <vector>

#include "engine/io/figures.h"
#include "engine/model/frame.h"
#include "render/renderer.h"

namespace sunder::app {

/// A sink that draws frame 0, which is not timed as it prepares the driver, and one of every
/// `every` frames after it. Throws InputError if there is no OpenGL context.
class DrawTimes final : public FrameSink {
 public:
  explicit DrawTimes(int every);
  void take(const FramePtr& frame) override;
  /// Returns `draw`, and for each drawn frame its times in `per_frame`. Empty without pictures.
  Figures figures() const;

 private:
  struct Picture {
    std::uint64_t frame;
    double ms, cpu_ms;
  };
  render::Renderer renderer_;
  std::uint64_t every_;
  std::vector<Picture> pictures_;
};

}  // namespace sunder::app
