// sunder trade: what accuracy costs, measured. A study is a list of runs; each is carried out in a
// process of its own and leaves a file, and reports are made of the files that are there.
//
// Read first: trade().
#include <algorithm>
#include <cstdio>
#include <map>

#include "bench/trade/merge.h"
#include "bench/trade/report.h"
#include "bench/trade/run_file.h"
#include "bench/trade/study.h"
#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/figures.h"
#include "scenes/app/apart.h"
#include "scenes/app/commands.h"
#include "scenes/app/work_progress.h"
#include "scenes/file/text_file.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;
using bench::StudyRun;

bench::Study study_of(const TradeOptions& options) {
  bench::Study study;
  study.scenes = options.scenes;
  study.points = options.points.empty()
                     ? bench::default_points()
                     : bench::parse_points(scenes::read_text(options.points), options.points);
  for (const std::string& assignment : options.switches) {
    bench::add_switch(study.points, assignment);
  }
  for (const std::string& assignment : options.load.set) {
    if (assignment.starts_with("scene.seed=")) {
      throw InputError("--set " + assignment +
                       ": every run of a study has a seed of its own; leave it out");
    }
  }
  study.set = options.load.set;
  study.seeds = options.seeds;
  study.frames = options.frames;
  return study;
}

int list_runs(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  Figures figures;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string line = runs[i].name() + "  " + runs[i].point.preset;
    for (const std::string& assignment : runs[i].set) line += " " + assignment;
    options.say(line + "\n");
    figures["/runs/" + std::to_string(i)] = runs[i].name();
  }
  options.write_json(format_figures(figures));
  return 0;
}

/// A run that is to be done, and how long it takes beside the others.
struct Due {
  StudyRun run;
  double work = 0;
};

/// Those whose files are not there. Loads every scene at every point first: what is wrong with the
/// input is known before anything runs.
std::vector<Due> due_of(const std::vector<StudyRun>& runs, const fs::path& folder) {
  set_threads(1);  // a process that has begun others cannot be copied
  std::vector<Due> due;
  std::map<std::pair<std::string, std::string>, double> work_at;
  for (const StudyRun& run : runs) {
    const auto [at, is_new] = work_at.try_emplace({run.scene, run.point.name});
    if (is_new) at->second = bench::work_of(bench::load_scene(run), run);
    const bench::StoredRun stored = bench::read_run(folder, run);
    if (stored.missing.empty()) continue;
    if (stored.damaged) {
      std::fprintf(stderr, "%s: %s, done again\n", run.name().c_str(), stored.missing.c_str());
    }
    due.push_back({run, at->second});
  }
  return due;
}

/// The exit code of a process that carries a run out and writes its files.
int carry_out_here(const TradeOptions& options, const StudyRun& run) {
  try {
    options.apply();
    bench::write_run(options.output, run, bench::carry_out(run));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s: %s\n", run.name().c_str(), error.what());
    return 1;
  }
}

/// In a process of its own, so that a crash is a result of this run. Answers whether the run has
/// its files then.
bool carry_out_apart(const TradeOptions& options, const StudyRun& run) {
  const Ended ended = run_apart([&] { return carry_out_here(options, run); });
  if (ended.crashed()) {
    bench::Ran crashed;
    crashed.result.failed = ended.how();
    bench::write_run(options.output, run, crashed);
    return true;
  }
  if (ended.signal != 0) {
    std::fprintf(stderr, "%s: %s\n", run.name().c_str(), ended.how().c_str());
    return false;
  }
  if (ended.exit_code != 0) throw FileError(run.name() + " has no file: nothing more is run");
  return true;
}

/// Answers whether all of them have their files then.
bool carry_out(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  const std::vector<Due> due = due_of(runs, options.output);
  double all = 0, done = 0;
  for (const Due& each : due) all += each.work;
  options.say(std::to_string(due.size()) + " of " + std::to_string(runs.size()) +
              " runs to be done\n");
  bool whole = true;
  WorkProgress progress("trade", options.quiet);
  for (const Due& each : due) {
    progress(each.run.name().c_str(), done / all);
    whole = carry_out_apart(options, each.run) && whole;
    done += each.work;
  }
  return whole;
}

int report(const TradeOptions& options, const std::vector<StudyRun>& runs) {
  const bench::Trade found = bench::merge(runs, options.output);
  const fs::path folder = options.output;
  const std::string json = bench::trade_json(found);
  write_text((folder / "trade.csv").string(), bench::trade_csv(found));
  write_text((folder / "trade.json").string(), json);
  write_text((folder / "trade.html").string(), bench::trade_html(found));
  for (const bench::SceneTrade& scene : found.scenes) {
    write_text((folder / (scene.scene + ".svg")).string(), bench::trade_svg(scene));
  }
  options.say(bench::trade_table(found) + "wrote " + (folder / "trade.html").string() + "\n");
  options.write_json(json);
  if (found.missing.empty()) return 0;
  for (const std::string& name : found.missing) std::fprintf(stderr, "missing: %s\n", name.c_str());
  std::fprintf(stderr, "failed: %zu of %zu runs are missing; the same command does them\n",
               found.missing.size(), found.runs);
  return 1;
}

}  // namespace

int trade(const TradeOptions& options) {
  const std::vector<StudyRun> all = bench::study_runs(study_of(options));
  const bool shared = !options.shard.empty();
  const std::vector<StudyRun> share =
      shared ? bench::share_of(all, bench::parse_shard(options.shard)) : all;
  if (options.list) return list_runs(options, share);
  if (options.output.empty()) throw InputError("-o DIR is missing: where the results go");
  if (options.merge) return report(options, all);
  const bool whole = carry_out(options, share);
  return shared ? (whole ? 0 : 1) : report(options, all);
}

}  // namespace sunder::app
