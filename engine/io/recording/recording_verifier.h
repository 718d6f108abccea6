// Comparison of a run with a recording, bit by bit.
#pragma once

#include <string>

#include "engine/io/recording/recording.h"

namespace sunder {

/// A sink that compares each frame with the next frame of a recording. A run that was resumed may
/// begin later than the recording.
class RecordingVerifier final : public FrameSink {
 public:
  /// `take` is read from its current position and must outlive this object.
  explicit RecordingVerifier(RecordingReader& take) : take_(take) {}

  void take(const FramePtr& frame) override;
  /// Returns the number of equal frames before the first that differs.
  std::uint32_t same() const { return same_; }
  /// Returns the first frame and body that differ; empty if none.
  const std::string& difference() const { return difference_; }

 private:
  RecordingReader& take_;
  std::uint32_t same_ = 0;
  std::string difference_;
};

}  // namespace sunder
