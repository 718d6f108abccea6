// What a frame spent its time on: the stages of a step, and within them what was counted.
#pragma once

#include <cstdint>

namespace sunder {

/// The stages of a step, in order.
enum class Stage { kAct, kCollide, kBreak, kSolve, kLoad, kParticles, kSnapshot };
inline constexpr int kStages = 7;
inline constexpr const char* kStageNames[kStages] = {"act",  "collide",   "break",   "solve",
                                                     "load", "particles", "snapshot"};

/// A part of a stage: what was counted there, the same on every machine, and the time that all of
/// it took; 0: it has none of its own.
struct WorkItem {
  Stage stage = Stage::kAct;
  const char* name = "";
  std::uint64_t count = 0;
  double ms = 0;
};

}  // namespace sunder
