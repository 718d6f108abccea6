// sunder simulate: runs a scene without rendering, and prints its statistics and state hash.
#include <cstdio>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/event_log.h"
#include "engine/io/recording/recording.h"
#include "engine/io/recording/recording_verifier.h"
#include "engine/io/statistics.h"
#include "engine/io/trace_file.h"
#include "scenes/app/run.h"
#include "scenes/app/run_notes.h"

namespace sunder::app {
namespace {

std::string megabytes(std::uint64_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

}  // namespace

int simulate(const SimulateOptions& options) {
  options.apply();
  Scene scene = scenes::load_scene(options.scene, options.load);
  const int last = last_frame(scene, options.frames, "--frames " + std::to_string(options.frames));
  Statistics statistics(scenes::run_info(scene, options.load.preset));
  Progress progress("simulate " + scene.name, last, options.quiet);
  StateHash hash;
  RunNotes notes(scene);
  const auto simulation = make_simulation(std::move(scene), {.count_loops = options.count_threads});
  FramesUntil frames(*simulation, last);
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
  if (!options.events.empty()) sinks.push_back(&events.emplace(options.events));
  if (!options.trace.empty()) start_trace();
  const int exit_code = pump_until_stopped(frames, sinks);
  if (!options.trace.empty()) {
    write_file(options.trace, format_trace(stop_trace()));
    options.print("wrote " + options.trace + ": open it at ui.perfetto.dev\n");
  }
  if (const std::string warning = statistics.limits_warning(); !warning.empty())
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
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
