// A study: every scene is run at every point with every seed. Runs are independent, so that they
// can be distributed over machines (bench/cluster/README.md). The seed of a run determines its
// fracture patterns and the phase of its steps: how far into a step an impact falls. The limit and
// each coarser limit have seeds of their own, because tests of equality need independent runs.
//
// Begin at study_runs(), then carry_out(). merge.h evaluates the results.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/trade/facts.h"
#include "scenes/trade/points.h"

namespace sunder::scenes {

struct Study {
  std::vector<std::string> scenes;  ///< Files or names.
  std::vector<StudyPoint> points;   ///< The last is the limit, unless nothing is compared with it.
  std::vector<std::string> set;     ///< key=value, for all runs.
  int seeds = 8;
  int frames = -1;  ///< Largest number of frames of a scene; negative: all.
};

/// Largest number of seeds.
inline constexpr int kMaxSeeds = 10000;

/// Everything that is needed to simulate a run on any machine.
struct StudyRun {
  std::string scene;  ///< Name of the scene.
  std::filesystem::path scene_file;
  std::string scene_hash;  ///< Hash of the text of the scene file.
  StudyPoint point;
  std::vector<std::string> set;  ///< key=value of the study, the point and the seed.
  int seed = 1;
  int frames = -1;

  /// Returns the name of the run's files without extension: "stack/realtime-1".
  std::string name() const;
  /// Returns the seed of the scene and of the phase, which no other limit has.
  int scene_seed() const;
};

/// Returns the runs by scene, then seed, then point: a disturbance of the machine affects all
/// points of a seed alike. Throws InputError if a scene does not exist or two scenes have one name.
std::vector<StudyRun> study_runs(const Study& study);

/// Share `index` of `count`, counted from 1.
struct Shard {
  int index = 1, count = 1;
};
/// Parses "I/N". Throws InputError.
Shard parse_shard(const std::string& text);
/// Returns every count-th of the runs.
std::vector<StudyRun> share_of(const std::vector<StudyRun>& runs, const Shard& shard);

/// Loads the scene with the settings of the run. Throws InputError.
Scene load_scene(const StudyRun& run);
/// Returns an estimate of the relative duration of the run, for progress display.
double work_of(const Scene& scene, const StudyRun& run);

/// Reproducible part of a run's result.
struct RunResult {
  Facts facts;
  std::string failed;  ///< Reason why there are no facts; empty if there are.
};
/// Times of a run, which are different each time.
struct RunTime {
  double cpu_ms = 0;   ///< Processor time per frame, of all threads.
  double wall_ms = 0;  ///< Wall time per frame.
  int frames = 0;
};
struct Ran {
  RunResult result;
  RunTime time;
};
/// Measures the first frame and `last` more of the source that begin() makes. An exception or a
/// body that is not finite becomes a failed result.
Ran measure(const std::function<std::unique_ptr<FrameSource>()>& begin, int last);
/// Returns a simulation whose steps are shifted by the seed in relation to what happens: the first
/// frame, and the first after each event of the script, takes longer by a random part of a frame.
/// All other frames take 1/60 s; there is no last frame.
std::unique_ptr<FrameSource> make_shifted_simulation(Scene scene, int seed);
/// Simulates a run. Throws InputError if the scene does not exist.
Ran carry_out(const StudyRun& run);

}  // namespace sunder::scenes
