// Tables of a run for scripts: the pose of every body in every frame, and the boxes of what is
// drawn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::tests {

/// Writes the tables that tests/check_glb.py reads.
class RunTables final : public FrameSink {
 public:
  /// `box_frames`: frames whose boxes are written.
  explicit RunTables(std::vector<std::uint64_t> box_frames) : box_frames_(std::move(box_frames)) {}
  void take(const FramePtr& frame) override;
  /// Writes the tables.
  void write(const std::filesystem::path& poses, const std::filesystem::path& boxes,
             const std::filesystem::path& chips) const;
  std::size_t bodies() const { return bodies_.size(); }

 private:
  std::vector<std::uint64_t> box_frames_;
  std::vector<double> poses_, boxes_, chips_;
  std::map<std::uint64_t, int> bodies_;  ///< Number of frames of each key.
};

}  // namespace sunder::tests
