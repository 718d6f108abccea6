// Comparison of a run with a recording, bit by bit.
#pragma once

#include <cstdint>
#include <string>

#include "engine/io/recording/recording.h"

namespace sunder {

/// A sink that compares each frame with the frame of a recording that has its index: states by
/// their hashes, and the meshes that are drawn. Either may begin or end later than the other.
class RecordingVerifier final : public FrameSink {
 public:
  /// `recording` is read from its current position and must outlive this object.
  explicit RecordingVerifier(RecordingReader& recording) : recording_(recording) {}

  void take(const FramePtr& frame) override;
  /// Returns true if a frame differs, or if the recording has ended before the run.
  bool fails() const { return different_ > 0 || ended_; }
  /// Returns true if some frame was compared, and nothing fails.
  bool passes() const { return same_ > 0 && !fails(); }
  /// Returns true if the recording is damaged before the first frame that differs.
  bool reached_damage() const { return ended_ && different_ == 0 && !recording_.damage().empty(); }
  /// Returns the result as a sentence: the number of equal frames; the first frame that differs,
  /// and what differs in it; frames of either that the other does not have.
  std::string result() const;

 private:
  std::string ranges_text() const;

  RecordingReader& recording_;
  FramePtr recorded_;            ///< Next frame of the recording.
  bool started_ = false;         ///< `recorded_` has been read.
  bool ended_ = false;           ///< The run has a frame after the last one of the recording.
  std::uint32_t read_ = 0;       ///< Number of frames read.
  std::uint64_t last_read_ = 0;  ///< Index of the last frame read.
  std::uint32_t same_ = 0, different_ = 0, not_recorded_ = 0;  ///< Numbers of frames of the run.
  std::uint64_t first_different_ = 0, last_compared_ = 0;      ///< Indices of frames.
  std::string difference_;                                     ///< In the first that differs.
};

}  // namespace sunder
