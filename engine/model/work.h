// Stages of a step, and the work counted in them.
#pragma once

#include <cstdint>

#include "engine/base/loop_times.h"

namespace sunder {

/// The stages of a step, in order.
enum class Stage { kAct, kCollide, kBreak, kSolve, kLoad, kParticles, kSnapshot };
inline constexpr int kStages = 7;
inline constexpr const char* kStageNames[kStages] = {"act",  "collide",   "break",   "solve",
                                                     "load", "particles", "snapshot"};

/// A part of a stage: a count, equal on every machine, and its time in ms; 0: not timed.
struct WorkItem {
  Stage stage = Stage::kAct;
  const char* name = "";
  std::uint64_t count = 0;
  double ms = 0;
  LoopTimes loops = {};  ///< Of its parallel loops, if they are counted.
};

}  // namespace sunder
