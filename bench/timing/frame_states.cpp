#include "bench/timing/frame_states.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "bench/timing/timing.h"
#include "engine/base/check.h"
#include "engine/io/statistics.h"
#include "scenes/file/schema.h"
#include "scenes/make_simulation.h"

namespace sunder::bench {
namespace {

constexpr std::size_t kDigits = 4;  // of a frame
constexpr int kFrames = 60, kFramesOfOthers = 10;

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const scenes::Preset& preset : scenes::presets()) names.emplace_back(preset.name);
  return names;
}

std::string digits_of(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return std::string(text, kDigits);
}

std::string place_of(const std::string& name, const std::string& preset) {
  return "frames/" + name + "/" + preset + "/";
}

/// The entry whose name begins so, and ends in a number; none if there is none.
struct Entry {
  int number = 0;
  std::string what, hash;
};
std::optional<Entry> find_entry(const HashBook& book, const std::string& place,
                                const std::string& file) {
  const auto found = book.lower_bound(place);
  if (found == book.end() || !found->first.starts_with(place)) return std::nullopt;
  Entry entry{0, found->first, found->second};
  const char* const end = entry.what.data() + entry.what.size();
  const auto [stop, error] = std::from_chars(entry.what.data() + place.size(), end, entry.number);
  constexpr int kMost = 100000;
  if (error != std::errc() || stop != end || entry.number < 0 || entry.number > kMost) {
    throw InputError(file + ": " + entry.what + ": after " + place + " stands a frame, from 0 to " +
                     std::to_string(kMost));
  }
  return entry;
}

std::unique_ptr<FrameSource> simulation_of(const GuardedRun& run, const std::string& preset,
                                           int& last) {
  scenes::LoadOptions load = run.load;
  load.preset = preset;
  Scene scene = scenes::load_scene(run.scene, load);
  last = last_frame(scene);
  return scenes::make_simulation(std::move(scene));
}

/// Of the frames 0 to `last`, or as many as the scene has.
StateHash states_until(const GuardedRun& run, const std::string& preset, int last) {
  int end = 0;
  const auto simulation = simulation_of(run, preset, end);
  StateHash states;
  for (int i = 0; i <= std::min(last, end); ++i) states.take(simulation->next());
  return states;
}

/// What the run comes to at a preset.
FrameStates found_states(const GuardedRun& run, const std::string& preset) {
  const int count = preset == run.load.preset ? kFrames : kFramesOfOthers;
  int end = 0;
  const auto simulation = simulation_of(run, preset, end);
  StateHash states;
  int last = run.frame;
  for (int i = 0; i <= std::min(last, end); ++i) {
    const FramePtr frame = simulation->next();
    const bool is_first = last == run.frame && !frame->breaks.empty();
    if (is_first) last = std::max(0, i - count / 6) + count - 1;
    states.take(frame);
  }
  last = std::min(last, end);
  return frame_states(preset, std::max(0, last - count + 1), last, states.per_frame());
}

Verdict judge_frames(const std::string& name, const FrameStates& known,
                     std::span<const std::uint64_t> run) {
  Verdict verdict{name, "simulation " + known.preset, Outcome::kPassed, {}};
  if (const std::optional<int> frame = first_difference(known, run)) {
    verdict.outcome = Outcome::kFailed;
    verdict.text = "differs from frame " + std::to_string(*frame) + " on" +
                   (*frame == known.first && *frame > 0 ? ", or from an earlier one" : "");
  } else {
    verdict.text = "frames " + std::to_string(known.first) + " to " + std::to_string(known.last()) +
                   " are as stored";
  }
  return verdict;
}

}  // namespace

int FrameStates::last() const { return first + static_cast<int>(digits.size() / kDigits) - 1; }

FrameStates frame_states(const std::string& preset, int first, int last,
                         std::span<const std::uint64_t> run) {
  FrameStates states{preset, first, {}};
  for (int i = first; i <= last; ++i) states.digits += digits_of(run[static_cast<std::size_t>(i)]);
  return states;
}

std::optional<int> first_difference(const FrameStates& known, std::span<const std::uint64_t> run) {
  for (int i = known.first; i <= known.last(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto in_known = static_cast<std::size_t>(i - known.first) * kDigits;
    if (at >= run.size() || digits_of(run[at]) != known.digits.substr(in_known, kDigits)) return i;
  }
  return std::nullopt;
}

std::vector<Verdict> judge_frames(const GuardedRun& run, const HashBook& book,
                                  const std::string& file, bool whole) {
  std::vector<Verdict> verdicts;
  for (const std::string& preset : preset_names()) {
    const auto entry = find_entry(book, place_of(run.name, preset), file);
    if (!entry) continue;
    const FrameStates known{preset, entry->number, entry->hash};
    std::optional<Entry> all;
    if (whole && run.load.set.empty()) {
      const std::string scene = scenes::scene_file(run.scene).stem().string();
      all = find_entry(book, "state/" + scene + "/" + preset + "/", file);
    }
    const int last = std::max(known.last(), all ? all->number : 0);
    const StateHash states = states_until(run, preset, last);
    verdicts.push_back(judge_frames(run.name, known, states.per_frame()));
    if (!all) continue;
    const std::string hash = states.hex(static_cast<std::size_t>(all->number) + 1);
    const bool same = hash == all->hash;
    verdicts.push_back({run.name, "simulation " + preset + " whole",
                        same ? Outcome::kPassed : Outcome::kFailed,
                        same ? all->what + " is as stored"
                             : all->what + " is " + hash + ", and " + all->hash + " stored"});
  }
  if (verdicts.empty()) {
    verdicts.push_back({run.name, "simulation", Outcome::kFailed,
                        "no states of it are stored: run: sunder golden accept " + run.name});
  }
  return verdicts;
}

void accept_frames(const GuardedRun& run, HashBook& book) {
  for (const std::string& preset : preset_names()) {
    const FrameStates found = found_states(run, preset);
    const std::string place = place_of(run.name, preset);
    std::erase_if(book, [&](const auto& entry) { return entry.first.starts_with(place); });
    book[place + std::to_string(found.first)] = found.digits;
  }
}

}  // namespace sunder::bench
