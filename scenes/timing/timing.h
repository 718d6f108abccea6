// Timing of a scene. Several runs, each in a process of its own, are combined into one object: that
// of `sunder simulate --json` with the median over the runs of every number.
//
// Begin at time_run(), then median_of(). All reports are made from these objects, so that they can
// be made again from a file without another run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/load.h"

namespace sunder::scenes {

/// Number of frames of a stored state hash; shorter scenes have the hash over all their frames.
inline constexpr int kStateFrames = 200;

struct TimedRun {
  std::string scene;  ///< File or name.
  LoadOptions load;
  int frames = kStateFrames;  ///< Limited by the number of frames of the scene.
  std::string without;        ///< Feature that is turned off (scenes/features.h); empty for none.
};

/// Returns the index of the last frame of a scene.
int last_frame(const Scene& scene);
/// Loads the scene with the options of the run. Throws InputError.
Scene load_scene(const TimedRun& run);
/// Simulates the run in this process, whose peak memory becomes that of the run. Returns the object
/// of Statistics with three additions: `set`, `memory_MB`, and in `state` the hash over `frames`
/// frames (kStateFrames, or all of a shorter scene). `state` is absent if the run is shorter.
Figures time_run(const TimedRun& run, bool warn);

/// Combines runs of the same scene: numbers are medians and texts are those of the first run. Times
/// of stages are computed from the median of each frame, which disturbances of single runs change
/// little, since all runs simulate the same. Adds `repeats`, `spread` (largest less least, over the
/// median, of the mean processor time of a frame), `repeat_ms` (mean of every run by stage and
/// clock), and `differs` (true if state hashes differ).
Figures median_of(std::span<const Figures> runs);

/// Convert between scenes and the document {"scenes": [...]}. scenes_of() also accepts the object
/// of `sunder simulate --json`, and throws InputError naming `file` for any other document.
Figures document_of(std::span<const Figures> scenes);
std::vector<Figures> scenes_of(const Figures& document, const std::string& file);

}  // namespace sunder::scenes
