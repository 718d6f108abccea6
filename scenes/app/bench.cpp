// sunder bench: repeatable frame timing. The state hash of every run must match, as timings of
// different simulations cannot be compared. bench/README.md explains the reports.
//
// Read first: bench(), then measure(). Every run is a process of its own and returns an object of
// figures, from which all reports are made.
#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/bytes.h"
#include "engine/io/figures.h"
#include "scenes/app/child_process.h"
#include "scenes/app/run.h"
#include "scenes/app/work_progress.h"
#include "scenes/features.h"
#include "scenes/file/text_file.h"
#include "scenes/timing/compare.h"
#include "scenes/timing/hash_book.h"
#include "scenes/timing/states.h"
#include "scenes/timing/timing.h"
#include "scenes/timing/timing_report.h"

namespace sunder::app {
namespace {

using scenes::TimedRun;
using scenes::Verdict;

/// A scene to time, maybe without a feature or by another program, and the figures of its repeats.
struct Timed {
  TimedRun run;
  std::string program;  ///< Path of the other program; empty: this one.
  /// Figures as JSON text, which is parsed after all runs, as these are forks of this process.
  std::vector<std::string> repeats = {};
};

/// Returns the runs of a turn, in order. Loads every scene, to find errors before anything runs.
std::vector<Timed> timed_runs(const BenchOptions& options) {
  std::vector<Timed> all;
  std::set<std::string> names;
  for (const std::string& asked : options.scenes) {
    TimedRun run{asked, options.load, options.frames, ""};
    const Scene scene = scenes::load_scene(run);
    run.frames = std::min(run.frames, scenes::last_frame(scene));
    if (!names.insert(scene.name).second) {
      throw InputError(asked + ": duplicate scene " + scene.name + "; time it in a separate run");
    }
    all.push_back({run, ""});
    if (!options.against.empty()) all.push_back({run, options.against});
    if (!options.features) continue;
    for (const scenes::Feature& feature : scenes::features()) {
      if (!feature.turn_off || feature.state(scene) != "on") continue;
      all.push_back({run, ""});
      all.back().run.without = feature.name;
    }
  }
  return all;
}

std::string title_of(const Timed& timed) {
  if (!timed.program.empty()) return timed.run.scene + " by " + timed.program;
  return timed.run.without.empty() ? timed.run.scene
                                   : timed.run.scene + " without " + timed.run.without;
}

/// Carries out a run in this process and writes its figures to the file. Returns an exit code.
int run_here(const BenchOptions& options, const Timed& timed, bool warn, std::FILE* file) {
  try {
    options.apply();
    const std::string text = format_figures(scenes::time_run(timed.run, warn));
    return std::fputs(text.c_str(), file) >= 0 && std::fflush(file) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", title_of(timed).c_str(), error.what());
    return 1;
  }
}

/// Replaces this process by the other program, with the file as output. Returns 1 if that fails.
int exec_program(const BenchOptions& options, const Timed& timed, std::FILE* file) {
  std::vector<std::string> words = {timed.program,   "simulate",
                                    timed.run.scene, "--quiet",
                                    "--json",        "-",
                                    "--preset",      timed.run.load.preset,
                                    "--frames",      std::to_string(timed.run.frames),
                                    "--threads",     std::to_string(options.threads)};
  for (const std::string& assignment : timed.run.load.set) {
    words.insert(words.end(), {"--set", assignment});
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it may be any program
  if (dup2(fileno(file), STDOUT_FILENO) >= 0) execv(timed.program.c_str(), arguments.data());
  return 1;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string text_of(std::FILE* file) {
  std::fseek(file, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  return text;
}

/// Restricts this process to one processor.
void pin_to(int processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  sched_setaffinity(0, sizeof set, &set);
}

/// Carries out runs and returns their figures as JSON; none if a stop signal was caught. Each run
/// has a process of its own, so that its peak memory is measured alone. Several runs share one
/// processor at the same time, so that disturbances, such as memory traffic, affect all equally.
std::vector<std::string> run_once(const BenchOptions& options, std::span<const Timed> runs,
                                  bool warn) {
  std::vector<File> files;
  std::vector<std::function<int()>> works;
  const int processor = runs.size() > 1 ? sched_getcpu() : -1;
  for (const Timed& timed : runs) {
    files.emplace_back(std::tmpfile(), &std::fclose);
    std::FILE* const file = files.back().get();
    if (!file)
      throw FileError("no temporary file can be created; set TMPDIR to a folder with free space");
    works.emplace_back([&options, &timed, warn, file, processor] {
      if (processor >= 0) pin_to(processor);
      return timed.program.empty() ? run_here(options, timed, warn, file)
                                   : exec_program(options, timed, file);
    });
  }
  const std::vector<ProcessResult> ended = run_in_child(works);
  if (stop_signal() != 0) return {};
  std::vector<std::string> figures;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (ended[i].signal != 0 || ended[i].exit_code != 0) {
      throw std::runtime_error(title_of(runs[i]) + " was not timed: " + ended[i].description());
    }
    figures.push_back(text_of(files[i].get()));
  }
  return figures;
}

/// Measurements: one object for each scene, and those of the other program, if there is one. Scenes
/// that were not measured before a stop signal are left out.
struct Measured {
  std::vector<Figures> scenes, others;
};

/// Returns the median of the repeats.
Figures median_of(const Timed& timed) {
  std::vector<Figures> repeats;
  for (const std::string& text : timed.repeats) {
    repeats.push_back(parse_figures(text, title_of(timed)));
  }
  return scenes::median_of(repeats);
}

/// Repeats all runs in turns, each run once in a turn, so that a temporary slowdown of the machine
/// affects all of them. Runs of a scene by this program and by the other are carried out at the
/// same time, if each has one thread. Ends early when a stop signal is caught.
void repeat(const BenchOptions& options, std::vector<Timed>& all) {
  const int turns = options.warm_up + options.repeats;
  WorkProgress progress("bench", options.quiet);
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0, count = 0; i < all.size(); i += count) {
      if (stop_signal() != 0) return;
      const double done = static_cast<double>(i) / static_cast<double>(all.size());
      progress(title_of(all[i]).c_str(), (turn + done) / turns);
      const bool has_other = i + 1 < all.size() && !all[i + 1].program.empty();
      count = has_other && options.threads == 1 ? 2 : 1;
      const auto figures = run_once(options, std::span(all).subspan(i, count),
                                    turn == 0 && all[i].run.without.empty());
      if (turn < options.warm_up || figures.empty()) continue;
      for (std::size_t k = 0; k < count; ++k) all[i + k].repeats.push_back(figures[k]);
    }
  }
}

Measured measure(const BenchOptions& options) {
  set_threads(1);  // run_in_child() forks, which a process with threads must not
  std::vector<Timed> all = timed_runs(options);
  catch_stop_signals();
  repeat(options, all);
  Measured measured;
  for (const Timed& timed : all) {
    if (timed.repeats.empty()) continue;
    const Figures median = median_of(timed);
    if (!timed.program.empty()) {
      measured.others.push_back(median);
    } else if (timed.run.without.empty()) {
      measured.scenes.push_back(median);
    } else {
      Figures& scene = measured.scenes.back();
      scene["/features/" + timed.run.without + "/cpu_mean_ms"] =
          number_at(median, "/frame/cpu_mean_ms");
    }
  }
  return measured;
}

std::vector<Figures> read_timings(const std::string& file) {
  return scenes::scenes_of(parse_figures(scenes::read_text(file), file), file);
}

/// Returns the fraction of --fail-slower by which a stage may be slower; none without the option.
std::optional<double> fail_slower_of(const BenchOptions& options) {
  if (options.fail_slower.empty()) return std::nullopt;
  if (options.compare.empty() && options.against.empty()) {
    throw InputError("--fail-slower needs --compare OLD.json or --against PROGRAM");
  }
  return scenes::parse_percent("--fail-slower", options.fail_slower);
}

void check_program(const std::string& program) {
  if (program.empty() ||
      (std::filesystem::is_regular_file(program) && access(program.c_str(), X_OK) == 0))
    return;
  throw InputError("--against " + program +
                   ": is not a program; give the path of another sunder, such as old/build/sunder");
}

}  // namespace

int bench(const BenchOptions& options) {
  const std::optional<double> fail_slower = fail_slower_of(options);
  check_program(options.against);
  scenes::StateHashes book = scenes::read_hashes(options.hashes);
  options.print((book.empty() ? "no stored states in " : "stored states of ") +
                place_text(options.hashes) + "\n");
  std::vector<Figures> old;
  if (!options.compare.empty()) old = read_timings(options.compare);

  Measured measured;
  if (options.from.empty()) {
    measured = measure(options);
  } else {
    measured.scenes = read_timings(options.from);
  }
  const int stopped = stop_signal();
  const std::vector<Figures>& scenes = measured.scenes;
  if (stopped != 0) {
    options.print(scenes.empty() ? "stopped before the first scene was timed; nothing is written\n"
                                 : "stopped; results of the runs that were timed:\n");
    if (scenes.empty()) return 128 + stopped;
  }
  const std::string old_name = options.against.empty() ? options.compare : options.against;
  if (!options.against.empty()) old = measured.others;
  if (options.accept && stopped == 0) {
    scenes::accept_states(scenes, book);
    const std::string installed = installed_goldens_folder() + "/hashes.txt";
    const std::string file =
        options.hashes == installed ? own_goldens_folder() + "/hashes.txt" : options.hashes;
    write_file(file, scenes::format_hashes(book));
    options.print("stored the states in " + file + "\n");
  }
  std::vector<Verdict> verdicts = scenes::compare_states(scenes, book, options.hashes);
  scenes::Comparison comparison;
  if (!old_name.empty()) {
    comparison = scenes::compare(scenes, old, old_name, fail_slower, !options.against.empty());
    verdicts.insert(verdicts.end(), comparison.verdicts.begin(), comparison.verdicts.end());
  }

  options.print(scenes::timing_table(scenes) + scenes::features_table(scenes) +
                scenes::changes_table(comparison.changes) + scenes::verdict_lines(verdicts, false));
  options.write_json(format_figures(scenes::document_of(scenes)));
  if (!options.junit.empty()) write_file(options.junit, scenes::junit_xml("bench", verdicts));
  if (!options.page.empty()) {
    write_file(options.page, scenes::timing_page(scenes, verdicts, comparison.changes));
  }
  const std::string failed = scenes::verdict_lines(verdicts, true);
  std::fputs(failed.c_str(), stderr);
  return stopped != 0 ? 128 + stopped : failed.empty() ? 0 : 1;
}

}  // namespace sunder::app
