#include "engine/io/scene_export/side_data.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace sunder {

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void SideData::add_breaks(const Frame& frame) {
  for (const BreakEvent& event : frame.breaks) {
    breaks_ << (breaks_count_++ > 0 ? ",\n" : "") << "{\"time_s\":" << event.time_s
            << ",\"parent\":" << event.parent_key << ",\"children\":[";
    for (std::size_t c = 0; c < event.child_keys.size(); ++c) {
      breaks_ << (c > 0 ? "," : "") << event.child_keys[c];
    }
    breaks_ << "],\"energy_J\":" << event.energy_J << ",\"point\":[" << event.point_W << "]";
    if (frame.names && event.name < frame.names->size()) {
      breaks_ << ",\"name\":" << json_string((*frame.names)[event.name]);
    }
    breaks_ << "}";
  }
}

void SideData::add_times(const Frame& frame) {
  stage_ms_ << (stage_ms_.text.empty() ? "[" : ",\n[");
  for (int stage = 0; stage < kStages; ++stage) {
    const double ms = std::round(frame.report.stage_ms[stage] * 1e3) / 1e3;
    has_times_ = has_times_ || ms > 0;
    stage_ms_ << (stage > 0 ? "," : "") << ms;
  }
  stage_ms_ << "]";
}

void SideData::describe(TextWriter& out) const {
  out << "\"breaks\":[" << breaks_.text << "]";
  if (!has_times_) return;
  out << ",\"stage_names\":[";
  for (int stage = 0; stage < kStages; ++stage) {
    out << (stage > 0 ? ",\"" : "\"") << kStageNames[stage] << "\"";
  }
  out << "],\"stage_ms\":[" << stage_ms_.text << "]";
}

}  // namespace sunder
