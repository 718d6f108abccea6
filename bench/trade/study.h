// A study: scenes, each run at every point with every seed. Runs know nothing of each other, so
// that any number of machines may share them (bench/cluster/README.md).
//
// Read first: study_runs(), then carry_out(). What becomes of the results is in merge.h.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/trade/facts.h"
#include "bench/trade/points.h"
#include "engine/model/scene.h"

namespace sunder::bench {

struct Study {
  std::vector<std::string> scenes;  ///< Files or names.
  std::vector<StudyPoint> points;   ///< The limit is the last.
  std::vector<std::string> set;     ///< key=value, for all runs.
  int seeds = 8;
  int frames = -1;  ///< At most so many of each scene; all if negative.
};

/// All there is to know to carry a run out, anywhere.
struct StudyRun {
  std::string scene;  ///< Its name.
  std::filesystem::path scene_file;
  std::string scene_hash;  ///< Of the file's text.
  StudyPoint point;
  std::vector<std::string> set;  ///< Of study, point and seed.
  int seed = 1;
  int frames = -1;

  /// Of its files, without an ending: "stack/realtime-1".
  std::string name() const;
};

/// Scene by scene and seed by seed, the points alternating within a seed: what disturbs a machine
/// for a while disturbs all points alike. Throws InputError if a scene is not there, or two have
/// one name.
std::vector<StudyRun> study_runs(const Study& study);

/// Share `index` of `count`, counted from 1.
struct Shard {
  int index = 1, count = 1;
};
/// "I/N". Throws InputError.
Shard parse_shard(const std::string& text);
/// Every count-th of the runs.
std::vector<StudyRun> share_of(const std::vector<StudyRun>& runs, const Shard& shard);

/// The scene as the run has it. Throws InputError.
Scene load_scene(const StudyRun& run);
/// Of the run, about, as far as time goes; for progress alone.
double work_of(const Scene& scene, const StudyRun& run);

/// What counts of a run.
struct RunResult {
  Facts facts;
  std::string failed;  ///< Why it has no facts; empty if it has.
};
/// What does not: it is never the same twice.
struct RunTime {
  double cpu_ms = 0;   ///< A frame, of all threads.
  double wall_ms = 0;  ///< A frame.
  int frames = 0;
};
struct Ran {
  RunResult result;
  RunTime time;
};
/// The first frame and `last` more of what begin() makes. Whatever is thrown, and a body that is
/// not finite, is a result.
Ran measure(const std::function<std::unique_ptr<FrameSource>()>& begin, int last);
/// Throws InputError if there is no such scene.
Ran carry_out(const StudyRun& run);

}  // namespace sunder::bench
