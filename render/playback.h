// Frame rate and playback speed of a video.
#pragma once

#include <cstdint>
#include <deque>

#include "render/frame_interpolation.h"

namespace sunder::render {

/// Frame rate and playback speed of a video of a run of 60 frames per second.
struct PlaybackRate {
  int frames_per_s = 60;  ///< Frame rate of the video.
  double speed = 1;       ///< Seconds of the run per second of the video.

  /// Returns the number of source frames from one picture of the video to the next.
  double step() const { return 60 * speed / frames_per_s; }
  /// Returns the first picture that is not before a source frame; picture 0 shows frame 0.
  std::uint64_t first_picture(std::uint64_t frame) const;
  /// Returns the last picture that is not after a source frame.
  std::uint64_t last_picture(std::uint64_t frame) const;
};

/// Resamples a source of numbered frames 1/60 s apart at another pace: each picture is a source
/// frame or an interpolation between two. Pictures are numbered from PlaybackRate.
class ResampledSource final : public FrameSource {
 public:
  /// Resamples `source`, which must outlive this. Before picture `first` there is at most one
  /// picture per source frame, without interpolation.
  ResampledSource(FrameSource& source, const PlaybackRate& pace, std::uint64_t first = 0)
      : source_(source), pace_(pace), first_(first) {}
  FramePtr next() override;

 private:
  bool read();
  const FrameInterval& interval();

  FrameSource& source_;
  PlaybackRate pace_;
  std::uint64_t first_;
  bool started_ = false, ended_ = false;
  std::uint64_t picture_ = 0;
  std::deque<FramePtr> frames_;  ///< Frames read, from the last one not after the picture on.
  FrameInterval interval_;
};

}  // namespace sunder::render
