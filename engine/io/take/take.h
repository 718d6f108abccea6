// Takes: recorded runs. One is written while a run goes on, and played from any frame on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder {

/// A sink that writes a take on a thread of its own; the same frames give the same bytes. The file
/// can be played up to the last frame that has reached it, however the run ends.
class TakeWriter final : public FrameSink {
 public:
  /// Throws FileError if the file cannot be written.
  explicit TakeWriter(const std::filesystem::path& path);
  ~TakeWriter() override;
  /// Throws FileError if an earlier frame could not be written.
  void take(const FramePtr& frame) override;
  /// Waits until all is written, and adds the index.
  void finish() override;
  /// So far; all of the file after finish().
  std::uint64_t bytes() const;

 private:
  class Recording;
  std::unique_ptr<Recording> recording_;
};

/// A source of what a take holds. What is cut short or corrupt is played as far as it can be read,
/// and damage() says what is wrong.
class TakeReader final : public FrameSource {
 public:
  /// Throws InputError if the file cannot be read, is no take of this version, or holds no frame
  /// that can be read.
  explicit TakeReader(const std::filesystem::path& path);
  ~TakeReader() override;
  /// Null at the end, or where the damage begins.
  FramePtr next() override;
  /// next() will give this one, counted from 0; the last if there are fewer.
  void seek(std::uint32_t frame);
  /// How many there are, as far as is known: later ones may turn out to be corrupt.
  std::uint32_t frames() const;
  /// Empty if nothing wrong has been met so far.
  const std::string& damage() const;
  /// Whether the run came to its end: else it was killed, or the file was cut short.
  bool is_complete() const;
  /// A short hash of the exact state of each body of the frame that next() gave last.
  const std::vector<std::int32_t>& body_hashes() const;

 private:
  class Playback;
  std::unique_ptr<Playback> playback_;
};

}  // namespace sunder
