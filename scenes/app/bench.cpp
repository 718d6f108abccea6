// sunder bench: repeatable frame timing. The state hash of every run must match, as timings of
// different simulations cannot be compared. bench/README.md explains the reports.
//
// Read first: bench(), then measure(). Every run is a process of its own, `sunder simulate`, and
// returns an object of figures, from which all reports are made.
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
#include "scenes/app/program_copy.h"
#include "scenes/app/run.h"
#include "scenes/app/work_progress.h"
#include "scenes/features.h"
#include "scenes/file/text_file.h"
#include "scenes/timing/compare.h"
#include "scenes/timing/hash_book.h"
#include "scenes/timing/judge.h"
#include "scenes/timing/machine.h"
#include "scenes/timing/pairs.h"
#include "scenes/timing/stalls.h"
#include "scenes/timing/states.h"
#include "scenes/timing/timing.h"
#include "scenes/timing/timing_report.h"

namespace sunder::app {
namespace {

using scenes::TimedRun;
using scenes::Verdict;

constexpr int kRepeats = 5;  // unless the user gives a number, or another program
constexpr const char* kThisProgram = "/proc/self/exe";

/// A scene to time, maybe without a feature or by another program, and the figures of its repeats.
struct Timed {
  TimedRun run;
  bool is_other = false;        ///< Timed by the other program.
  ProgramCopy* copy = nullptr;  ///< Copies of the program, if it is compared; null: run as it is.
  std::vector<Figures> repeats = {};
};

int repeats_of(const BenchOptions& options) {
  if (options.repeats > 0) return options.repeats;
  return options.against.empty() ? kRepeats : scenes::kJudgedRepeats;
}

/// Returns true if the runs of both programs are timed at once on one processor.
bool is_at_once(const BenchOptions& options) {
  return !options.against.empty() && options.threads == 1;
}

/// Returns the runs of a turn, in order. Loads every scene, to find errors before anything runs.
std::vector<Timed> timed_runs(const BenchOptions& options, ProgramCopy* copy, ProgramCopy* other) {
  std::vector<Timed> all;
  std::set<std::string> names;
  for (const std::string& asked : options.scenes) {
    TimedRun run{asked, options.load, options.frames, "", options.draw};
    const Scene scene = scenes::load_scene(run);
    run.frames = std::min(run.frames, scenes::last_frame(scene));
    if (!names.insert(scene.name).second) {
      throw InputError(asked + ": duplicate scene " + scene.name + "; time it in a separate run");
    }
    all.push_back({run, false, copy});
    if (!options.against.empty()) all.push_back({run, true, other});
    if (!options.features) continue;
    for (const scenes::Feature& feature : scenes::features()) {
      if (!feature.turn_off || feature.state(scene) != "on") continue;
      all.push_back({run});
      all.back().run.without = feature.name;
    }
  }
  return all;
}

std::string title_of(const BenchOptions& options, const Timed& timed) {
  if (timed.is_other) return timed.run.scene + " by " + options.against;
  return timed.run.without.empty() ? timed.run.scene
                                   : timed.run.scene + " without " + timed.run.without;
}

/// Replaces this process by `sunder simulate` of a program. Programs that are compared are called
/// in the same way, so that nothing else differs. Returns 1 if that fails.
int exec_program(const BenchOptions& options, const TimedRun& run, const std::string& program,
                 std::FILE* out, std::FILE* messages) {
  std::vector<std::string> words = {"sunder",    "simulate",
                                    run.scene,   "--quiet",
                                    "--json",    "-",
                                    "--preset",  run.load.preset,
                                    "--frames",  std::to_string(run.frames),
                                    "--threads", std::to_string(options.threads)};
  for (const std::string& assignment : run.load.set)
    words.insert(words.end(), {"--set", assignment});
  if (run.draw > 0) words.insert(words.end(), {"--draw", std::to_string(run.draw)});
  if (!run.without.empty()) words.insert(words.end(), {"--without", run.without});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it may be any program
  if (dup2(fileno(out), STDOUT_FILENO) < 0 || dup2(fileno(messages), STDERR_FILENO) < 0) return 1;
  execv(program.c_str(), arguments.data());
  std::perror(
      (program + ": cannot be started; set TMPDIR to a folder of which programs may run").c_str());
  return 1;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporary_file() {
  File file(std::tmpfile(), &std::fclose);
  if (!file)
    throw FileError("no temporary file can be created; set TMPDIR to a folder with free space");
  return file;
}

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

/// Carries out runs, and adds their figures to their repeats; to none if a stop signal was caught.
/// Each run has a process of its own, so that its peak memory is measured alone. Several runs share
/// one processor at the same time, so that disturbances, such as memory traffic, affect all
/// equally. With `warn`, the warnings of the runs are printed.
void run_once(const BenchOptions& options, std::span<Timed* const> runs, bool warn) {
  std::vector<File> files, messages;
  std::vector<std::function<int()>> works;
  const int processor = runs.size() > 1 ? sched_getcpu() : -1;
  for (const Timed* timed : runs) {
    std::FILE* const out = files.emplace_back(temporary_file()).get();
    std::FILE* const said = messages.emplace_back(temporary_file()).get();
    const std::string program = timed->copy ? timed->copy->renew() : kThisProgram;
    works.emplace_back([&options, timed, program, out, said, processor] {
      if (processor >= 0) pin_to(processor);
      return exec_program(options, timed->run, program, out, said);
    });
  }
  const std::vector<ProcessResult> ended = run_in_child(works);
  if (stop_signal() != 0) return;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string said = text_of(messages[i].get());
    const std::string title = title_of(options, *runs[i]);
    if (ended[i].signal != 0 || ended[i].exit_code != 0)
      throw std::runtime_error(title + " was not timed: " + ended[i].description() +
                               (said.empty() ? "" : "\n" + said));
    if (warn && !runs[i]->is_other) std::fputs(said.c_str(), stderr);
    Figures& figures = runs[i]->repeats.emplace_back(parse_figures(text_of(files[i].get()), title));
    scenes::keep_for_reports(figures);
    figures["/machine/processors"] = scenes::allowed_processors();
    figures["/at_once"] = static_cast<std::int64_t>(runs.size());
  }
}

/// Measurements: one object for each scene. Scenes that were not measured before a stop signal are
/// left out.
struct Measured {
  std::vector<Figures> scenes, others;
};

/// Repeats all runs in turns, each run once in a turn, so that a temporary slowdown of the machine
/// affects all of them. Runs of a scene by this program and by the other are carried out at the
/// same time, if each has one thread; the one that starts first is the other in the next turn. Ends
/// early when a stop signal is caught.
void repeat(const BenchOptions& options, std::vector<Timed>& all) {
  const int turns = options.warm_up + repeats_of(options);
  WorkProgress progress("bench", options.quiet);
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < all.size();) {
      if (stop_signal() != 0) return;
      const double done = static_cast<double>(i) / static_cast<double>(all.size());
      progress(title_of(options, all[i]).c_str(), (turn + done) / turns);
      const bool warn = turn == 0 && all[i].run.without.empty();
      std::vector<Timed*> runs = {&all[i++]};
      if (i < all.size() && all[i].is_other) runs.push_back(&all[i++]);
      if (turn % 2 != 0) std::ranges::reverse(runs);
      if (is_at_once(options)) {
        run_once(options, runs, warn);
      } else {
        for (Timed* run : runs) run_once(options, std::span(&run, 1), warn);
      }
      for (Timed* run : runs) {
        if (turn < options.warm_up) run->repeats.clear();
      }
    }
  }
}

/// Adds the pairs of runs of this program and of the other to the figures of a scene, unless they
/// simulate something else, so that their times cannot be judged.
void put_pairs(const BenchOptions& options, const Timed& now, const Timed& before, Figures& scene) {
  const std::size_t pairs = std::min(now.repeats.size(), before.repeats.size());
  if (pairs == 0) return;
  const std::string hash = "/state_hash";
  if (text_at(now.repeats.front(), hash) != text_at(before.repeats.front(), hash)) return;
  scene["/against/program"] = options.against;
  for (const auto& [place, value] : before.repeats.front()) {
    if (place == "/commit" || place.starts_with("/build/")) scene["/against" + place] = value;
  }
  scenes::put_pairs(scenes::paired_figures(std::span(now.repeats).first(pairs),
                                           std::span(before.repeats).first(pairs)),
                    scene);
}

Measured measure(const BenchOptions& options) {
  set_threads(1);  // run_in_child() forks, which a process with threads must not
  std::optional<ProgramCopy> copy, other;
  if (!options.against.empty()) {
    copy.emplace(kThisProgram);
    other.emplace(options.against);
  }
  std::vector<Timed> all = timed_runs(options, copy ? &*copy : nullptr, other ? &*other : nullptr);
  catch_stop_signals();
  repeat(options, all);
  Measured measured;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Timed& timed = all[i];
    if (timed.repeats.empty()) continue;
    const Figures median = scenes::median_of(timed.repeats);
    if (timed.is_other) {
      measured.others.push_back(median);
    } else if (timed.run.without.empty()) {
      Figures& scene = measured.scenes.emplace_back(median);
      if (!options.against.empty()) put_pairs(options, timed, all[i + 1], scene);
    } else {
      Figures& scene = measured.scenes.back();
      scene["/features/" + timed.run.without + "/cpu_mean_ms"] =
          number_at(median, "/frame/cpu_mean_ms");
    }
  }
  return measured;
}

std::vector<Figures> read_timings(const std::string& file) {
  return scenes::scenes_of(parse_figures(scenes::read_text(file, file_kinds::kFigures), file),
                           file);
}

/// Returns the bounds of --fail-slower; none without the option. Throws InputError if what is asked
/// for could never fail, or could fail by chance.
std::optional<scenes::Bounds> bounds_of(const BenchOptions& options) {
  if (options.fail_slower.empty()) return std::nullopt;
  if (!options.compare.empty())
    throw InputError(
        "--fail-slower with --compare: two files cannot tell a slower program from a machine that "
        "was slower at the time; use --against PROGRAM, which times both programs at once");
  if (options.against.empty() && options.from.empty())
    throw InputError("--fail-slower needs --against PROGRAM, the program before the change");
  const scenes::Bounds bounds = scenes::parse_bounds("--fail-slower", options.fail_slower);
  if (options.against.empty()) return bounds;
  const std::size_t figures =
      options.scenes.size() *
      (options.draw > 0 ? scenes::kMaxPairedFiguresDrawn : scenes::kMaxPairedFigures);
  const std::size_t least = scenes::least_repeats(figures);
  if (static_cast<std::size_t>(repeats_of(options)) < least)
    throw InputError("--repeats " + std::to_string(repeats_of(options)) +
                     ": too few for --fail-slower, which judges up to " + std::to_string(figures) +
                     " figures of these scenes and could not tell any; "
                     "give --repeats " +
                     std::to_string(least) + " or more");
  return bounds;
}

/// Checks that timings from a file have what --fail-slower judges.
void check_pairs(const std::string& file, const scenes::Judgements& judgements) {
  if (judgements.figures.empty())
    throw InputError(
        "--fail-slower: " + file +
        " has no pairs of runs; give a file of `sunder bench --against PROGRAM --json`");
  if (judgements.has_too_few())
    throw InputError("--fail-slower: " + file + " has " + std::to_string(judgements.repeats) +
                     " repeats, too few to tell anything; at least " +
                     std::to_string(judgements.least_repeats) + " are needed");
}

void check_program(const std::string& program) {
  if (program.empty() ||
      (std::filesystem::is_regular_file(program) && access(program.c_str(), X_OK) == 0))
    return;
  throw InputError("--against " + program +
                   ": is not a program; give the path of another sunder, such as old/build/sunder");
}

std::string stall_lines(const Measured& measured, const std::string& other) {
  std::string text;
  for (const Figures& scene : measured.scenes)
    text += scenes::stall_lines(scene, text_at(scene, "/scene"));
  for (const Figures& scene : measured.others)
    text += scenes::stall_lines(scene, text_at(scene, "/scene") + " by " + other);
  return text;
}

std::string changes_table(const BenchOptions& options, const scenes::Comparison& comparison) {
  const std::string table = scenes::changes_table(comparison.changes);
  if (table.empty() || options.compare.empty()) return table;
  return table +
         "two files cannot tell what changed, the program or the machine in the time between; "
         "--against PROGRAM can\n";
}

/// Stores the states of the scenes as the expected ones.
void accept_states(const BenchOptions& options, std::span<const Figures> scenes,
                   scenes::StateHashes& book) {
  scenes::accept_states(scenes, book);
  const std::string installed = installed_goldens_folder() + "/hashes.txt";
  const std::string file =
      options.hashes == installed ? own_goldens_folder() + "/hashes.txt" : options.hashes;
  write_file(file, scenes::format_hashes(book));
  options.print("stored the states in " + file + "\n");
}

}  // namespace

int bench(const BenchOptions& options) {
  const std::optional<scenes::Bounds> bounds = bounds_of(options);
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
  std::vector<Figures>& scenes = measured.scenes;
  if (stopped != 0) {
    options.print(scenes.empty() ? "stopped before the first scene was timed; nothing is written\n"
                                 : "stopped; results of the runs that were timed:\n");
    if (scenes.empty()) return 128 + stopped;
  }
  const std::string old_name = options.against.empty() ? options.compare : options.against;
  if (!options.against.empty()) old = measured.others;
  const scenes::Judgements judgements = scenes::judge(scenes, bounds);
  if (bounds && !options.from.empty()) check_pairs(options.from, judgements);
  if (options.accept && stopped == 0) accept_states(options, scenes, book);
  std::vector<Verdict> verdicts = scenes::compare_states(scenes, book, options.hashes);
  scenes::Comparison comparison;
  if (!old_name.empty()) comparison = scenes::compare(scenes, old, old_name);
  std::erase_if(comparison.changes, [&](const scenes::Change& change) {  // judgements say more
    return std::ranges::find(judgements.figures, change.scene, &scenes::Judged::scene) !=
           judgements.figures.end();
  });
  verdicts.insert(verdicts.end(), comparison.verdicts.begin(), comparison.verdicts.end());
  verdicts.insert(verdicts.end(), judgements.verdicts.begin(), judgements.verdicts.end());
  scenes::put_judgements(judgements, scenes);

  options.print(scenes::timing_table(scenes) + scenes::features_table(scenes) +
                stall_lines(measured, options.against) + changes_table(options, comparison) +
                scenes::judgements_table(judgements) + scenes::verdict_lines(verdicts, false));
  options.write_json(format_figures(scenes::document_of(scenes)));
  if (!options.junit.empty()) write_file(options.junit, scenes::junit_xml("bench", verdicts));
  if (!options.page.empty()) {
    write_file(options.page, scenes::timing_page(scenes, verdicts, comparison.changes, judgements));
  }
  const std::string failed = scenes::verdict_lines(verdicts, true);
  std::fputs(failed.c_str(), stderr);
  return stopped != 0 ? 128 + stopped : failed.empty() ? 0 : 1;
}

}  // namespace sunder::app
