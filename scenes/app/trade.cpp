// sunder trade: measures the cost of accuracy. A study is a list of runs. Each run is carried out
// in a process of its own and writes a file; reports are made of the files.
//
// Read first: trade().
#include <algorithm>
#include <cstdio>
#include <map>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/bytes.h"
#include "engine/io/figures.h"
#include "scenes/app/child_process.h"
#include "scenes/app/commands.h"
#include "scenes/app/work_progress.h"
#include "scenes/file/text_file.h"
#include "scenes/trade/equal.h"
#include "scenes/trade/merge.h"
#include "scenes/trade/report.h"
#include "scenes/trade/run_file.h"
#include "scenes/trade/study.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;
using scenes::StudyRun;

/// Returns the number of runs that groups of equal runs are drawn from.
int pool_of(const TradeOptions& options) {
  if (options.seeds < 2)
    throw InputError("--equal: --seeds is " + std::to_string(options.seeds) +
                     "; expected 2 or more, as groups of one run have no spread");
  const int pool = options.pool > 0 ? options.pool : std::min(4 * options.seeds, scenes::kMaxSeeds);
  if (pool < 2 * options.seeds)
    throw InputError("--pool " + std::to_string(pool) + ": expected at least " +
                     std::to_string(2 * options.seeds) + ", two groups of --seeds");
  return pool;
}

/// Returns the points before --switch; the last is the limit.
std::vector<scenes::StudyPoint> points_of(const TradeOptions& options) {
  if (!options.points.empty())
    return scenes::parse_points(scenes::read_text(options.points, file_kinds::kText),
                                options.points);
  std::vector<scenes::StudyPoint> points = scenes::default_points();
  if (options.equal > 0)
    std::erase_if(points, [](const scenes::StudyPoint& point) {
      return !point.is_limit() && point.name != "realtime";
    });
  return points;
}

scenes::Study study_of(const TradeOptions& options) {
  scenes::Study study;
  study.scenes = options.scenes;
  study.points = points_of(options);
  for (const std::string& assignment : options.switches) {
    scenes::add_switch(study.points, assignment);
  }
  for (const std::string& assignment : options.load.set) {
    if (assignment.starts_with("scene.seed=")) {
      throw InputError("--set " + assignment +
                       ": every run of a study has its own seed; remove the option");
    }
  }
  study.set = options.load.set;
  study.seeds = options.seeds;
  study.frames = options.frames;
  if (options.equal > 0) {
    study.points.pop_back();  // nothing is compared with the limit
    study.seeds = pool_of(options);
  } else {
    scenes::add_coarser_limits(study.points, study.set);
  }
  return study;
}

int list_runs(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  Figures figures;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string line = runs[i].name() + "  " + runs[i].point.preset;
    for (const std::string& assignment : runs[i].set) line += " " + assignment;
    options.print(line + "\n");
    figures["/runs/" + std::to_string(i)] = runs[i].name();
  }
  options.write_json(format_figures(figures));
  return 0;
}

/// A run to carry out, and an estimate of its time relative to the others.
struct PendingRun {
  StudyRun run;
  double work = 0;
};

/// Returns the runs that have no file yet. Loads every scene at every point first, so that errors
/// of the input are found before anything runs.
std::vector<PendingRun> pending_runs(const std::vector<StudyRun>& runs, const fs::path& folder) {
  set_threads(1);  // run_in_child() forks, which a process with threads must not
  std::vector<PendingRun> pending;
  std::map<std::pair<std::string, std::string>, double> work_at;
  for (const StudyRun& run : runs) {
    const auto [at, is_new] = work_at.try_emplace({run.scene, run.point.name});
    if (is_new) at->second = scenes::work_of(scenes::load_scene(run), run);
    const scenes::StoredRun stored = scenes::read_run(folder, run);
    if (stored.missing.empty()) continue;
    if (stored.damaged) {
      std::fprintf(stderr, "%s: %s; run again\n", run.name().c_str(), stored.missing.c_str());
    }
    pending.push_back({run, at->second});
  }
  return pending;
}

/// Carries out a run in this process and writes its files. Returns an exit code.
int carry_out_here(const TradeOptions& options, const StudyRun& run) {
  try {
    options.apply();
    scenes::write_run(options.output, run, scenes::carry_out(run));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s: %s\n", run.name().c_str(), error.what());
    return 1;
  }
}

/// Carries out a run in a child process; a crash is stored as the result of the run. Returns true
/// if the run has its files.
bool carry_out_in_child(const TradeOptions& options, const StudyRun& run) {
  const ProcessResult ended = run_in_child([&] { return carry_out_here(options, run); });
  if (ended.crashed()) {
    scenes::Ran crashed;
    crashed.result.failed = ended.description();
    scenes::write_run(options.output, run, crashed);
    return true;
  }
  if (ended.signal != 0) {
    std::fprintf(stderr, "%s: %s\n", run.name().c_str(), ended.description().c_str());
    return false;
  }
  if (ended.exit_code != 0) throw FileError(run.name() + " wrote no file; stopped");
  return true;
}

/// Carries out the runs that have no file yet. Returns true if all runs have their files.
bool carry_out(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  const std::vector<PendingRun> pending = pending_runs(runs, options.output);
  double all = 0, done = 0;
  for (const PendingRun& each : pending) all += each.work;
  options.print(std::to_string(pending.size()) + " of " + std::to_string(runs.size()) +
                " runs to be done\n");
  bool complete = true;
  WorkProgress progress("trade", options.quiet);
  for (const PendingRun& each : pending) {
    progress(each.run.name().c_str(), done / all);
    complete = carry_out_in_child(options, each.run) && complete;
    done += each.work;
  }
  return complete;
}

/// Prints the names of missing runs. Returns an exit code.
int list_missing(const std::vector<std::string>& missing, std::size_t of) {
  if (missing.empty()) return 0;
  for (const std::string& name : missing) std::fprintf(stderr, "missing: %s\n", name.c_str());
  std::fprintf(stderr,
               "failed: %zu of %zu runs are missing; run the same command again to complete them\n",
               missing.size(), of);
  return 1;
}

int report_equal(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  const scenes::EqualStudy found =
      scenes::compare_equal(runs, options.output, options.seeds, options.equal);
  const std::string json = scenes::equal_json(found);
  const fs::path file = fs::path(options.output) / "equal.json";
  write_file(file, json);
  options.print(scenes::equal_table(found) + "wrote " + file.string() + "\n");
  options.write_json(json);
  return list_missing(found.missing, found.runs);
}

int report(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  if (options.equal > 0) return report_equal(options, runs);
  const scenes::Trade found = scenes::merge(runs, options.output);
  const fs::path folder = options.output;
  const std::string json = scenes::trade_json(found);
  write_file(folder / "trade.csv", scenes::trade_csv(found));
  write_file(folder / "trade.json", json);
  write_file(folder / "trade.html", scenes::trade_html(found));
  for (const scenes::SceneTrade& scene : found.scenes) {
    write_file(folder / (scene.scene + ".svg"), scenes::trade_svg(scene));
  }
  options.print(scenes::trade_table(found) + "wrote " + (folder / "trade.html").string() + "\n");
  options.write_json(json);
  return list_missing(found.missing, found.runs);
}

}  // namespace

int trade(const TradeOptions& options) {
  const std::vector<StudyRun> all = scenes::study_runs(study_of(options));
  const bool shared = !options.shard.empty();
  const std::vector<StudyRun> share =
      shared ? scenes::share_of(all, scenes::parse_shard(options.shard)) : all;
  if (options.list) return list_runs(options, share);
  if (options.output.empty()) throw InputError("-o DIR is missing: the folder of the results");
  if (options.merge) return report(options, all);
  const bool complete = carry_out(options, share);
  return shared ? (complete ? 0 : 1) : report(options, all);
}

}  // namespace sunder::app
