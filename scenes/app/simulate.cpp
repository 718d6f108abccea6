// sunder simulate: runs a scene without rendering, and prints its statistics and state hash.
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/event_log.h"
#include "engine/io/recording/recording.h"
#include "engine/io/recording/recording_verifier.h"
#include "engine/io/statistics.h"
#include "engine/io/trace_file.h"
#include "engine/model/checks/item_check.h"
#include "engine/world/simulation.h"
#include "scenes/app/run.h"
#include "scenes/app/run_notes.h"

namespace sunder::app {
namespace {

std::string megabytes(std::uint64_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

/// Returns the world of the scene, or of the saved state, of the options.
World make_world(const SimulateOptions& options) {
  if (options.scene.empty() && options.resume.empty())
    throw InputError("SCENE is required, or --resume with the file of a saved state");
  const scenes::SimulationOptions simulation =
      simulation_options({.count_loops = options.count_threads});
  if (options.resume.empty())
    return scenes::make_world(scenes::load_scene(options.scene, options.load), simulation);
  return scenes::restore_world(read_file(options.resume), simulation, options.resume);
}

/// The frames of a simulation; saves its state at a time.
class SavingSource final : public FrameSource {
 public:
  SavingSource(Simulation& simulation, const SimulateOptions& options)
      : simulation_(simulation), options_(options), saved_(options.save_at.second.empty()) {}

  FramePtr next() override {
    FramePtr frame = simulation_.next();
    constexpr double kRounding_s = 1e-9;
    if (frame && !saved_ && frame->time_s >= options_.save_at.first - kRounding_s) {
      write_file(options_.save_at.second, scenes::save_world(simulation_.world()));
      saved_ = true;
    }
    return frame;
  }
  bool saved() const { return saved_; }

 private:
  Simulation& simulation_;
  const SimulateOptions& options_;
  bool saved_;
};

}  // namespace

int simulate(const SimulateOptions& options) {
  options.apply();
  Simulation simulation(make_world(options));
  const Scene& scene = simulation.world().scene();
  const int first = static_cast<int>(std::lround(simulation.world().time_s() * 60));
  const int last = last_frame(scene, options.frames, "--frames " + std::to_string(options.frames));
  if (last < first)
    throw InputError("--frames " + std::to_string(last) + ": the saved state is of frame " +
                     std::to_string(first));
  const double save_s = options.save_at.first;
  if (!options.save_at.second.empty() && !(save_s >= first / 60.0 && save_s <= last / 60.0))
    throw InputError("--save-at " + number_text(save_s) + ": expected a time of the run, from " +
                     number_text(first / 60.0) + " to " + number_text(last / 60.0) + " s");
  Statistics statistics(scenes::run_info(scene, options.load.preset));
  Progress progress("simulate " + scene.name, last, options.quiet);
  StateHash hash;
  simulation.world().report_hits(options.hits_m_s);
  RunNotes notes(scene, simulation.world().time_s());
  SavingSource saving(simulation, options);
  FramesUntil frames(saving, last - first);
  std::vector<FrameSink*> sinks = {&statistics, &hash, &notes, &progress};
  std::optional<RecordingReader> recording;
  std::optional<RecordingVerifier> verifier;
  if (!options.verify.empty()) {
    recording.emplace(options.verify);
    sinks.push_back(&verifier.emplace(*recording));
  }
  std::optional<RecordingWriter> writer;
  if (!options.take.empty()) sinks.push_back(&writer.emplace(options.take));
  std::optional<EventLog> events;
  if (!options.events.empty()) sinks.push_back(&events.emplace(options.events, simulation.world()));
  if (!options.trace.empty()) start_trace();
  const int exit_code = pump_until_stopped(frames, sinks);
  if (!options.trace.empty()) {
    write_file(options.trace, format_trace(stop_trace()));
    options.print("wrote " + options.trace + ": open it at ui.perfetto.dev\n");
  }
  if (const std::string warning = statistics.limits_warning(); !warning.empty())
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (saving.saved() && !options.save_at.second.empty())
    options.print("wrote " + options.save_at.second + "\n");
  options.print(statistics.table() + "state hash " + hash.hex() + "\n" + notes.text());
  options.write_json(statistics.json(hash.hex(), /*per_frame=*/true));
  if (writer) options.print("wrote " + options.take + ", " + megabytes(writer->bytes()) + "\n");
  if (events)
    options.print("wrote " + options.events + ", " + std::to_string(events->events()) +
                  " events\n");
  if (exit_code != 0 || !verifier) return exit_code;
  const std::string same = std::to_string(verifier->same());
  if (verifier->difference().empty()) {
    options.print(same + " frames match the recording\n");
    return 0;
  }
  std::fprintf(stderr, "failed: the run differs from %s after %s equal frames: %s\n",
               options.verify.c_str(), same.c_str(), verifier->difference().c_str());
  return 1;
}

}  // namespace sunder::app
