// Recordings of runs ("takes"): written during a run, and played from any frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder {

/// A sink that writes a recording on a thread of its own; equal frames give equal bytes. The file
/// can be played up to the last frame written, however the run ends.
class RecordingWriter final : public FrameSink {
 public:
  /// Creates the file; throws FileError if it cannot be written.
  explicit RecordingWriter(const std::filesystem::path& path);
  ~RecordingWriter() override;
  /// Queues a frame; throws FileError if an earlier frame could not be written.
  void take(const FramePtr& frame) override;
  /// Waits until all frames are written, then writes the index.
  void finish() override;
  /// Returns the number of bytes written; complete after finish().
  std::uint64_t bytes() const;

 private:
  class Recording;
  std::unique_ptr<Recording> recording_;
};

/// True if a file begins as recordings of all versions do.
bool is_recording(const std::filesystem::path& path);

/// A source that plays a recording. A truncated or corrupt file is played as far as it can be read,
/// and damage() describes the fault.
class RecordingReader final : public FrameSource {
 public:
  /// Opens a recording; throws InputError if the file cannot be read, is not a recording of this
  /// version, or has no readable frame.
  explicit RecordingReader(const std::filesystem::path& path);
  ~RecordingReader() override;
  /// Returns the next frame; null at the end, or where the damage begins.
  FramePtr next() override;
  /// Sets the frame that next() returns, counted from 0; the last one if there are fewer.
  void seek(std::uint32_t frame);
  /// Returns the number of frames as far as known: later ones may turn out to be corrupt.
  std::uint32_t frames() const;
  /// Returns a description of the damage found so far; empty if none.
  const std::string& damage() const;
  /// True if the run finished; false if it was killed, or the file is truncated.
  bool is_complete() const;
  /// Returns short hashes (frame_coder.h) of each body of the frame that next() returned last.
  const std::vector<std::int32_t>& body_hashes() const;

 private:
  class Playback;
  std::unique_ptr<Playback> playback_;
};

}  // namespace sunder
