// sunder simulate: runs a scene without rendering, and prints its statistics and state hash.
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/event_log.h"
#include "engine/io/figures.h"
#include "engine/io/recording/recording.h"
#include "engine/io/recording/recording_verifier.h"
#include "engine/io/statistics.h"
#include "engine/io/trace_file.h"
#include "engine/model/checks/item_check.h"
#include "engine/world/simulation.h"
#include "scenes/app/build_info.h"
#include "scenes/app/draw_times.h"
#include "scenes/app/run.h"
#include "scenes/app/run_notes.h"
#include "scenes/features.h"
#include "scenes/timing/machine.h"
#include "scenes/timing/timing.h"

namespace sunder::app {
namespace {

std::string megabytes(std::uint64_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

/// Returns the names of the features that can be turned off.
std::string names_of_features() {
  std::string names;
  for (const scenes::Feature& feature : scenes::features()) {
    if (feature.turn_off) names += (names.empty() ? "" : ", ") + std::string(feature.name);
  }
  return names;
}

/// Returns the world of the scene, or of the saved state, of the options. Sets `so_far` to what was
/// saved with the state.
World make_world(const SimulateOptions& options, scenes::RunSoFar& so_far) {
  const scenes::Feature* const feature = scenes::find_feature(options.without);
  if (!options.without.empty() && !(feature && feature->turn_off))
    throw InputError("--without " + options.without + ": expected one of " + names_of_features());
  if (options.scene.empty() && options.resume.empty())
    throw InputError("SCENE is required, or --resume with the file of a saved state");
  const scenes::SimulationOptions simulation =
      simulation_options({.count_loops = options.count_threads});
  if (!options.resume.empty())
    return scenes::restore_world(read_file(options.resume, file_kinds::kState), simulation,
                                 options.resume, &so_far);
  const scenes::TimedRun run{
      .scene = options.scene, .load = options.load, .without = options.without};
  return scenes::make_world(scenes::load_scene(run), simulation);
}

/// A sink of what is said of a whole run, which includes the frames up to the saved state that the
/// run goes on from.
class RunTotals final : public FrameSink {
 public:
  /// `start_s`: time of the first frame that is taken.
  RunTotals(const Scene& scene, const std::string& preset, double start_s,
            const scenes::RunSoFar& so_far)
      : statistics(scenes::run_info(scene, preset)),
        notes(scene, so_far.totals.empty() ? start_s : 0),
        is_whole_(start_s == 0 || !so_far.totals.empty()) {
    if (so_far.totals.empty()) return;
    Archive bytes(so_far.totals);
    bytes(statistics, hash, notes);
    bytes.finish();
    has_first_frame_ = true;
  }
  void take(const FramePtr& frame) override {
    if (std::exchange(has_first_frame_, false)) return;
    for (FrameSink* const sink : std::initializer_list<FrameSink*>{&statistics, &hash, &notes})
      sink->take(frame);
  }
  /// Returns what restores these totals.
  scenes::RunSoFar so_far() {
    Archive bytes;
    bytes(statistics, hash, notes);
    const auto [failed, failed_m3] = statistics.failed();
    return {failed, failed_m3, bytes.take()};
  }

  /// Returns true unless the run goes on from a state that was saved without its totals.
  bool is_whole() const { return is_whole_; }

  Statistics statistics;
  StateHash hash;
  RunNotes notes;

 private:
  bool is_whole_;
  bool has_first_frame_ = false;  ///< The first frame taken, that of the saved state, is included.
};

/// A sink that saves the state of a world at a time, with the totals of the frames up to there.
class StateSaver final : public FrameSink {
 public:
  StateSaver(const World& world, RunTotals& totals, double time_s, std::string file)
      : world_(world), totals_(totals), time_s_(time_s), file_(std::move(file)) {}
  void take(const FramePtr& frame) override {
    constexpr double kRounding_s = 1e-9;
    if (saved_ || frame->time_s < time_s_ - kRounding_s) return;
    write_file(file_, scenes::save_world(world_, totals_.so_far()));
    saved_ = true;
  }
  bool saved() const { return saved_; }

 private:
  const World& world_;
  RunTotals& totals_;
  double time_s_;
  std::string file_;
  bool saved_ = false;
};

/// A source of another source's frames that ends where they differ from a recording.
class VerifiedSource final : public FrameSource {
 public:
  VerifiedSource(FrameSource& source, const RecordingVerifier& verifier)
      : source_(source), verifier_(verifier) {}
  FramePtr next() override { return verifier_.fails() ? nullptr : source_.next(); }

 private:
  FrameSource& source_;
  const RecordingVerifier& verifier_;
};

/// Prints the result of a verification. Returns the exit code; throws InputError if the recording
/// is damaged.
int report(const SimulateOptions& options, const RecordingVerifier& verifier) {
  if (verifier.reached_damage()) throw InputError(options.verify + ": " + verifier.result());
  if (verifier.passes()) {
    options.print(verifier.result() + "\n");
    return 0;
  }
  std::fprintf(stderr, "failed: %s: %s\n", options.verify.c_str(), verifier.result().c_str());
  return 1;
}

/// Returns what a run of this program is besides its statistics.
Figures figures_of_run(const SimulateOptions& options, const RunTotals& totals, int last_frame) {
  Figures figures;
  if (totals.is_whole()) figures = scenes::state_figures(totals.hash, last_frame);
  figures.merge(scenes::machine_figures());
  figures.merge(build_figures());
  for (std::size_t i = 0; i < options.load.set.size(); ++i)
    figures["/set/" + std::to_string(i)] = options.load.set[i];
  if (!options.without.empty()) figures["/without"] = options.without;
  figures["/memory_MB"] = scenes::peak_memory_MB();
  return figures;
}

}  // namespace

int simulate(const SimulateOptions& options) {
  options.apply();
  scenes::RunSoFar so_far;
  Simulation simulation(make_world(options, so_far));
  const Scene& scene = simulation.world().scene();
  const double start_s = simulation.world().time_s();
  const int first = static_cast<int>(std::lround(start_s * 60));
  const int last = last_frame(scene, options.frames, "--frames " + std::to_string(options.frames));
  if (last < first)
    throw InputError("--frames " + std::to_string(last) + ": the saved state is of frame " +
                     std::to_string(first));
  const double save_s = options.save_at.first;
  if (!options.save_at.second.empty() && !(save_s >= first / 60.0 && save_s <= last / 60.0))
    throw InputError("--save-at " + number_text(save_s) + ": expected a time of the run, from " +
                     number_text(first / 60.0) + " to " + number_text(last / 60.0) + " s");
  RunTotals totals(scene, options.load.preset, start_s, so_far);
  const Statistics& statistics = totals.statistics;
  if (!options.resume.empty()) {
    for (const std::string& warning : statistics.info().warnings)
      simulation_options().warn(scene.name + ": " + warning);
  }
  Progress progress("simulate " + scene.name, last, options.quiet);
  simulation.world().report_hits(options.hits_m_s);
  FramesUntil until(simulation, last - first);
  FrameSource* frames = &until;
  std::vector<FrameSink*> sinks = {&totals, &progress};
  std::optional<StateSaver> saver;
  if (!options.save_at.second.empty())
    sinks.push_back(&saver.emplace(simulation.world(), totals, save_s, options.save_at.second));
  std::optional<DrawTimes> draw;
  if (options.draw > 0) sinks.push_back(&draw.emplace(options.draw));
  std::optional<RecordingReader> recording;
  std::optional<RecordingVerifier> verifier;
  std::optional<VerifiedSource> verified;
  if (!options.verify.empty()) {
    recording.emplace(options.verify);
    sinks.push_back(&verifier.emplace(*recording));
    if (!options.keep_going) frames = &verified.emplace(until, *verifier);
  }
  std::optional<RecordingWriter> writer;
  if (!options.take.empty()) sinks.push_back(&writer.emplace(options.take));
  std::optional<EventLog> events;
  if (!options.events.empty()) sinks.push_back(&events.emplace(options.events, simulation.world()));
  if (!options.trace.empty()) start_trace();
  const int exit_code = pump_until_stopped(*frames, sinks);
  if (!options.trace.empty()) {
    write_file(options.trace, format_trace(stop_trace()));
    options.print("wrote " + options.trace + ": open it at ui.perfetto.dev\n");
  }
  if (const std::string warning = statistics.limits_warning(); !warning.empty())
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (saver && saver->saved()) options.print("wrote " + options.save_at.second + "\n");
  const std::string hash = totals.hash.hex();
  options.print(statistics.table() + "state hash " + hash + "\n" + totals.notes.text());
  if (!options.json.empty()) {
    Figures figures = figures_of_run(options, totals, scenes::last_frame(scene));
    if (draw) figures.merge(draw->figures());
    options.write_json(add_figures(statistics.json(hash, /*per_frame=*/true), figures));
  }
  if (writer) options.print("wrote " + options.take + ", " + megabytes(writer->bytes()) + "\n");
  if (events)
    options.print("wrote " + options.events + ", " + std::to_string(events->events()) +
                  " events\n");
  return exit_code != 0 || !verifier ? exit_code : report(options, *verifier);
}

}  // namespace sunder::app
