// Timing of a scene. Several runs, each in a process of its own, are combined into one object: that
// of `sunder simulate --json` with the median over the runs of every number.
//
// Begin at median_of(). All reports are made from these objects, so that they can be made again
// from a file without another run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/load.h"

namespace sunder::scenes {

/// Number of frames of a stored state hash; shorter scenes have the hash over all their frames.
inline constexpr int kStateFrames = 200;

/// A run of `sunder simulate`.
struct TimedRun {
  std::string scene;  ///< File or name.
  LoadOptions load;
  int frames = kStateFrames;  ///< Limited by the number of frames of the scene.
  std::string without;        ///< Feature that is turned off (scenes/features.h); empty for none.
  int draw = 0;               ///< Every so many frames one is drawn; 0: none is.
};

/// Returns the index of the last frame of a scene.
int last_frame(const Scene& scene);
/// Loads the scene with the options of the run. Throws InputError.
Scene load_scene(const TimedRun& run);
/// Erases what no report uses from the object of `sunder simulate --json`: the work of single
/// frames.
void keep_for_reports(Figures& run);

/// Combines runs of the same scene: numbers are medians and texts are those of the first run. Mean,
/// p50 and p95 are of the median of each frame, which disturbances of single runs change little,
/// since all runs simulate the same; p99 and max are of all frames of all runs, so that what is
/// slow in one run is seen. Adds `repeats`, `spread` (largest less least, over the median, of the
/// mean processor time of a frame), `repeat_ms` (mean of every run by stage and clock), `stalls`
/// (stalls.h), and `differs` (true if state hashes differ).
Figures median_of(std::span<const Figures> runs);

/// Convert between scenes and the document {"scenes": [...]}. scenes_of() also accepts the object
/// of `sunder simulate --json`, and throws InputError naming `file` for any other document.
Figures document_of(std::span<const Figures> scenes);
std::vector<Figures> scenes_of(const Figures& document, const std::string& file);

}  // namespace sunder::scenes
