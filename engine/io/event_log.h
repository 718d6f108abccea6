// Events of a run as lines of JSON, for programs that follow what happens without reading frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "engine/model/frame.h"

namespace sunder {

/// Writes a line of JSON for each event to a file: bodies that appear, break, disappear, fall
/// asleep or wake, and joints that are lost. docs/json.md lists the members. Equal runs give equal
/// files.
class EventLog final : public FrameSink {
 public:
  /// Creates the file, and its folder; throws FileError if it cannot be written.
  explicit EventLog(const std::filesystem::path& path);
  /// Throws FileError if the disk is full.
  void take(const FramePtr& frame) override;
  void finish() override;
  std::uint64_t events() const { return events_; }

 private:
  struct Known {
    bool asleep = false;
    std::uint64_t frame = 0;  ///< Index of the last frame that has the body.
  };

  std::filesystem::path path_;
  std::ofstream out_;
  std::map<std::uint64_t, Known> known_;  ///< Bodies of the previous frame by key.
  std::uint64_t events_ = 0;
};

}  // namespace sunder
