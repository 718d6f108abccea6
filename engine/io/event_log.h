// Events of a run as lines of JSON, for programs that follow what happens without reading frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "engine/model/frame.h"
#include "engine/world/world.h"

namespace sunder {

/// Writes a line of JSON for each event of a world to a file: hits, if the world reports them,
/// bodies that break, appear, fall asleep, wake or disappear, and joints that are lost. Those are
/// the events of World::events(), with the state of each body that appears. docs/json.md lists the
/// members. Equal runs give equal files.
class EventLog final : public FrameSink {
 public:
  /// Creates the file, and its folder; throws FileError if it cannot be written. Frames that are
  /// taken must be those of `world` after each step, and before the next one.
  EventLog(const std::filesystem::path& path, const World& world);
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
  const World& world_;
  std::map<std::uint64_t, Known> known_;  ///< Bodies of the previous frame by key.
  std::uint64_t events_ = 0;
};

}  // namespace sunder
