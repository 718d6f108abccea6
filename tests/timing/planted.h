// Made-up timings, so that no test depends on a clock.
#pragma once

#include <string>

#include "engine/io/figures.h"
#include "engine/model/work.h"

namespace sunder::tests {

/// Returns the timings of a scene in which every stage takes `ms` by either clock, and a frame the
/// sum of its stages.
inline Figures made_up_timings(const std::string& scene, double ms, int frames = 200) {
  Figures figures = {{"/scene", scene},
                     {"/preset", std::string("realtime")},
                     {"/threads", std::int64_t{1}},
                     {"/frames", std::int64_t{frames}},
                     {"/cpu", std::string("a processor")},
                     {"/state_hash", std::string("0123456789abcdef")},
                     {"/state/frames", std::int64_t{200}},
                     {"/state/hash", std::string("fedcba9876543210")},
                     {"/differs", false}};
  for (const std::string clock : {"", "cpu_"}) {
    for (const std::string figure : {"p50_ms", "mean_ms"}) {
      for (const char* stage : kStageNames) {
        figures[std::string("/stages/") + stage + "/" + clock + figure] = ms;
      }
      figures["/frame/" + clock + figure] = kStages * ms;
    }
  }
  for (int frame = 0; frame < frames; ++frame) {
    for (const char* stage : kStageNames) {
      const std::string at = "/per_frame/" + std::to_string(frame);
      figures[at + "/stages_ms/" + stage] = figures[at + "/stages_cpu_ms/" + stage] = ms;
    }
  }
  return figures;
}

}  // namespace sunder::tests
