// Stalls: frames that took much longer in one repeat of a run than in the others. All repeats
// simulate the same, so that a stall is due to something besides the simulation: the machine, or a
// program that now and then waits or does more.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"

namespace sunder::scenes {

/// A frame stalls if its wall time exceeds its median over the repeats by this time, one picture of
/// a display of 60 Hz, and by kStallShare of the median.
inline constexpr double kStall_ms = 1000.0 / 60;
inline constexpr double kStallShare = 0.5;

struct Stall {
  int repeat = 0;                ///< From 1.
  int frame = 0;                 ///< Frame of the scene; frame 0 takes no time.
  double ms = 0, excess_ms = 0;  ///< Wall time, and the part of it beyond the frame's median.
  std::string stage;             ///< Stage that exceeds its median most.
  double stage_excess_ms = 0, processor_excess_ms = 0;
};

/// Returns the stalls in runs of the same scene, the longest first. Drawing counts as a stage.
std::vector<Stall> find_stalls(std::span<const Figures> runs);

/// Returns the number of stalls in each of `repeats` repeats.
std::vector<double> count_stalls(std::span<const Stall> stalls, std::size_t repeats);

/// Writes the longest stalls of `find_stalls()`, and the number of all, to `stalls` of a scene.
void put_stalls(std::span<const Stall> stalls, Figures& scene);

/// Returns a line for each of the longest stalls of a scene: "frame 132 of repeat 3 took 48.0 ms of
/// wall time, 41.0 ms more than its median: 39.0 ms more in stage load, ...". `of`: name of the
/// run.
std::string stall_lines(const Figures& scene, const std::string& of);

}  // namespace sunder::scenes
