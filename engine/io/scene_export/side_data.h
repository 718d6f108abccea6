// Data that viewers of an exported run show beside its geometry: breaks, and the time of each
// frame.
#pragma once

#include <cstdint>
#include <string>

#include "engine/io/text_writer.h"
#include "engine/model/frame.h"

namespace sunder {

/// Returns a text as a JSON string.
std::string json_string(const std::string& text);

/// Collects the breaks of all frames, and the time that each stage of a step took in each frame.
class SideData {
 public:
  void add_breaks(const Frame& frame);
  void add_times(const Frame& frame);
  /// Appends the JSON members "breaks", and "stage_names" and "stage_ms" if any time is known.
  void describe(TextWriter& out) const;
  std::uint64_t breaks() const { return breaks_count_; }

 private:
  TextWriter breaks_{","}, stage_ms_{","};
  std::uint64_t breaks_count_ = 0;
  bool has_times_ = false;
};

}  // namespace sunder
