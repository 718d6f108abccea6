// How fast a film goes: any number of pictures a second, and time drawn out or pressed together.
#pragma once

#include <cstdint>
#include <deque>

#include "render/passage.h"

namespace sunder::render {

struct Pace {
  int frames_per_s = 60;  ///< Of the film.
  double speed = 1;       ///< Seconds of the run in a second of it.

  /// Frames of the source from picture to picture.
  double step() const { return 60 * speed / frames_per_s; }
  /// The first picture that shows a frame of the source or what comes after it, and the last that
  /// shows it or what comes before; picture 0 shows frame 0.
  std::uint64_t first_picture(std::uint64_t frame) const;
  std::uint64_t last_picture(std::uint64_t frame) const;
};

/// The pictures of a source of frames, 1/60 s apart and numbered, at another pace: each is a frame
/// of the source, or what is between two of them. They are numbered anew, as Pace says.
class PacedSource final : public FrameSource {
 public:
  /// Of those before picture `first` there is one a frame at most, and it is not worked out.
  PacedSource(FrameSource& source, const Pace& pace, std::uint64_t first = 0)
      : source_(source), pace_(pace), first_(first) {}
  FramePtr next() override;

 private:
  bool read();
  const Interval& interval();

  FrameSource& source_;
  Pace pace_;
  std::uint64_t first_;
  bool started_ = false, ended_ = false;
  std::uint64_t picture_ = 0;
  std::deque<FramePtr> frames_;  ///< What has been read, from the one before the picture on.
  Interval interval_;
};

}  // namespace sunder::render
