#include "scenes/timing/frame_states.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "engine/io/state_hash.h"
#include "engine/io/statistics.h"
#include "scenes/file/schema.h"
#include "scenes/make_simulation.h"
#include "scenes/timing/timing.h"

namespace sunder::scenes {
namespace {

constexpr std::size_t kDigits = 4;  // hexadecimal digits per frame, or per second
constexpr std::ptrdiff_t kFramesPerSecond = 60;
// Number of frames to store after the first break, at the run's own preset and at others.
constexpr int kFramesAfterBreak = 50, kFramesAfterBreakOtherPresets = 8;

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

std::string digits_of(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return std::string(text, kDigits);
}

std::string frames_key(const std::string& name, const std::string& preset) {
  return "frames/" + name + "/" + preset;
}
std::string seconds_key(const GuardedRun& run) {
  return "seconds/" + run.name + "/" + run.load.preset;
}

/// A stored state hash of `sunder bench` over the first frames of a scene.
struct StoredState {
  int frames = 0;
  std::string what, hash;
};
std::optional<StoredState> find_stored_state(const StateHashes& book, const std::string& scene,
                                             const std::string& preset, const std::string& file) {
  const std::string place = "state/" + scene + "/" + preset + "/";
  const auto found = book.lower_bound(place);
  if (found == book.end() || !found->first.starts_with(place)) return std::nullopt;
  const std::string& what = found->first;
  const char* const end = what.data() + what.size();
  StoredState state{0, what, found->second};
  const auto [stop, error] = std::from_chars(what.data() + place.size(), end, state.frames);
  if (error != std::errc() || stop != end || state.frames < 0) {
    throw InputError(file + ": key '" + what + "': expected a number of frames after '" + place +
                     "'");
  }
  return state;
}

/// Returns the frame that shows the first action of a scene's script; -1 if it has none.
int first_action(const Scene& scene) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double first_s = scene.moves.empty() ? kNever : 0;
  const auto include = [&](const auto& actions) {
    for (const auto& action : actions) first_s = std::min(first_s, action.time_s);
  };
  include(scene.shots);
  include(scene.blasts);
  include(scene.removals);
  include(scene.drives);
  return first_s < kNever ? static_cast<int>(std::ceil(60 * first_s)) : -1;
}

struct Run {
  std::unique_ptr<FrameSource> simulation;
  int last = 0;           ///< Last frame of the scene.
  int first_action = -1;  ///< As returned by first_action().
};
Run run_of(const GuardedRun& run, const std::string& preset) {
  LoadOptions load = run.load;
  load.preset = preset;
  Scene scene = load_scene(run.scene, load);
  const int last = last_frame(scene), first_act = first_action(scene);
  return {make_simulation(std::move(scene)), last, first_act};
}

/// Returns the hashes of frames 0 to `last`, or of all frames of a shorter scene. Sets `frame` to
/// GuardedRun::frame, unless the simulation ends before.
StateHash hash_frames(const GuardedRun& run, const std::string& preset, int last, FramePtr& frame) {
  const Run setup = run_of(run, preset);
  StateHash states;
  for (int i = 0; i <= std::min(last, setup.last); ++i) {
    const FramePtr next = setup.simulation->next();
    if (i == run.frame) frame = next;
    states.take(next);
  }
  return states;
}

/// Returns the digits to store for a run; a break before the script's first action does not end it.
std::string record_digits(const GuardedRun& run, const std::string& preset) {
  const bool is_own = preset == run.load.preset;
  const int after = is_own ? kFramesAfterBreak : kFramesAfterBreakOtherPresets;
  const int least = is_own && run.is_drawn ? run.frame : 0;
  const auto [simulation, last, first_act] = run_of(run, preset);
  StateHash states;
  int end = std::min(run.frame > first_act ? run.frame : first_act + after, last);
  bool has_broken = false;
  for (int i = 0; i <= end; ++i) {
    const FramePtr frame = simulation->next();
    if (!has_broken && i >= first_act && !frame->breaks.empty()) {
      has_broken = true;
      end = std::min(std::max(i + after, least), last);
    }
    states.take(frame);
  }
  return frame_digits(states.per_frame());
}

Verdict check_digits(const GuardedRun& run, const std::string& preset, const std::string& known,
                     std::span<const std::uint64_t> states) {
  Verdict verdict{run.name, "simulation at " + preset, Outcome::kPassed, {}};
  if (const std::optional<int> frame = first_difference(known, states)) {
    verdict.outcome = Outcome::kFailed;
    verdict.text = "differs from frame " + std::to_string(*frame) + " on";
  } else {
    verdict.text = std::to_string(known.size() / kDigits) + " frames are equal to the stored ones";
  }
  return verdict;
}

/// Compares each second of a whole run with the stored digits.
Verdict check_seconds(const GuardedRun& run, const StateHashes& book, const std::string& file,
                      std::span<const std::uint64_t> states) {
  Verdict verdict{run.name, "simulation to its end at " + run.load.preset, Outcome::kFailed, {}};
  const auto known = book.find(seconds_key(run));
  if (known == book.end()) {
    verdict.text = "has no stored states in " + file + "; store them by `sunder golden accept`";
    return verdict;
  }
  const std::string digits = second_digits(states);
  const auto seconds = [](const std::string& text) {
    return std::to_string(text.size() / kDigits);
  };
  const auto [stored, now] = std::ranges::mismatch(known->second, digits);
  const auto second = (now - digits.begin()) / static_cast<std::ptrdiff_t>(kDigits);
  if (stored == known->second.end() && now == digits.end()) {
    verdict.outcome = Outcome::kPassed;
    verdict.text = seconds(digits) + " seconds are equal to the stored ones";
  } else if (stored == known->second.end() || now == digits.end()) {
    verdict.text = "has " + seconds(digits) + " seconds; " + seconds(known->second) + " are stored";
  } else {
    verdict.text = "differs from second " + std::to_string(second) + " on (frame " +
                   std::to_string(second * kFramesPerSecond) + ")";
  }
  return verdict;
}

Verdict check_state(const GuardedRun& run, const std::string& preset, const StoredState& known,
                    const StateHash& states) {
  const std::string hash = states.hex(static_cast<std::size_t>(known.frames) + 1);
  const bool same = hash == known.hash;
  return {run.name, "whole simulation at " + preset, same ? Outcome::kPassed : Outcome::kFailed,
          known.what + " is " + hash +
              (same ? ", equal to the stored state" : "; the stored state is " + known.hash)};
}

}  // namespace

std::string frame_digits(std::span<const std::uint64_t> run) {
  std::string digits;
  for (const std::uint64_t hash : run) digits += digits_of(hash);
  return digits;
}

std::string second_digits(std::span<const std::uint64_t> run) {
  std::string digits;
  while (!run.empty()) {
    const auto second = run.first(std::min<std::size_t>(run.size(), kFramesPerSecond));
    digits += hash_run(second).substr(0, kDigits);
    run = run.subspan(second.size());
  }
  return digits;
}

std::optional<int> first_difference(const std::string& known, std::span<const std::uint64_t> run) {
  for (std::size_t i = 0; i * kDigits < known.size(); ++i) {
    if (i >= run.size() || digits_of(run[i]) != known.substr(i * kDigits, kDigits)) {
      return static_cast<int>(i);
    }
  }
  return std::nullopt;
}

FrameComparison compare_frames(const GuardedRun& run, const StateHashes& book,
                               const std::string& file, bool with_bench_state) {
  FrameComparison comparison;
  std::vector<Verdict>& verdicts = comparison.verdicts;
  const std::string scene = scene_file(run.scene).stem().string();
  for (const std::string& preset : preset_names()) {
    const auto known = book.find(frames_key(run.name, preset));
    if (known == book.end()) continue;
    std::optional<StoredState> all;
    if (with_bench_state && run.load.set.empty())
      all = find_stored_state(book, scene, preset, file);
    const int frames = static_cast<int>(known->second.size() / kDigits);
    const Stopwatch watch;
    FramePtr frame;
    const bool is_own = preset == run.load.preset;
    const bool is_whole = is_own && run.to_the_end;
    const int last = std::max(frames - 1, all ? all->frames : 0);
    const StateHash states =
        hash_frames(run, preset, is_whole ? std::numeric_limits<int>::max() : last, frame);
    if (is_own) {
      comparison.frame = frame;
      comparison.is_same =
          run.frame < first_difference(known->second, states.per_frame()).value_or(frames);
    }
    verdicts.push_back(check_digits(run, preset, known->second, states.per_frame()));
    verdicts.back().seconds = 1e-3 * watch.ms();  // includes the time of the next two
    if (is_whole) verdicts.push_back(check_seconds(run, book, file, states.per_frame()));
    if (all) verdicts.push_back(check_state(run, preset, *all, states));
  }
  if (verdicts.empty()) {
    verdicts.push_back(
        {run.name, "simulation", Outcome::kFailed,
         "has no stored states in " + file + "; store them by `sunder golden accept`"});
  }
  return comparison;
}

void accept_frames(const GuardedRun& run, StateHashes& book) {
  for (const std::string& preset : preset_names()) {
    book[frames_key(run.name, preset)] = record_digits(run, preset);
  }
  if (run.to_the_end) {
    FramePtr frame;
    book[seconds_key(run)] = second_digits(
        hash_frames(run, run.load.preset, std::numeric_limits<int>::max(), frame).per_frame());
  } else {
    book.erase(seconds_key(run));
  }
}

}  // namespace sunder::scenes
