// A scene's timing: several runs of it, each in a process of its own, become one object, the one of
// `sunder simulate --json` with the median over the runs of every number in it.
//
// Read first: time_run(), then median_of(). All that is reported is made of these objects, so a
// file of them can be looked at again without running anything.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "scenes/load.h"

namespace sunder::bench {

/// Frames that a stored state hash is over, or all of a scene that ends before.
inline constexpr int kStateFrames = 200;

struct TimedRun {
  std::string scene;  ///< File or name.
  scenes::LoadOptions load;
  int frames = kStateFrames;  ///< Or as many as the scene has.
  std::string without;        ///< A feature that is turned off (scenes/features.h); none if empty.
};

/// Index of the last frame of a scene.
int last_frame(const Scene& scene);
/// The scene as the run has it. Throws InputError.
Scene load_scene(const TimedRun& run);
/// Carries it out, in this process, whose peak memory is the run's. Beside what Statistics say:
/// `set`, `memory_MB`, and in `state` the hash over `frames`, kStateFrames or all there are; absent
/// if the run is shorter.
Figures time_run(const TimedRun& run, bool warn);

/// Of runs of the same: the median of every number, the first run's texts; times of stages are of
/// the frames' medians, as every frame does the same in every run, and what disturbs one does not
/// disturb the same in most. And over the runs `repeats`, `spread` (largest less least over the
/// median, of the processor time of all frames), `repeat_ms`, by stage and clock the mean of every
/// run, and `differs`, true if their states do.
Figures median_of(std::span<const Figures> runs);

/// The document {"scenes": [...]}, and back: also the object of `sunder simulate --json`. Throws
/// InputError naming `file` if it is neither.
Figures document_of(std::span<const Figures> scenes);
std::vector<Figures> scenes_of(const Figures& document, const std::string& file);

}  // namespace sunder::bench
