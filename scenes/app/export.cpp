// sunder export: writes a run or a recording as a file for other programs.
//
// Read first: export_scene() and write_run().
#include "scenes/app/export.h"

#include <cstdio>
#include <filesystem>
#include <memory>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/figures.h"
#include "engine/io/frames_ahead.h"
#include "engine/io/recording/recording.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

/// The frames to export.
struct ExportInput {
  std::unique_ptr<FrameSource> source;
  std::string name;
  int last = 0;
  RecordingReader* recording = nullptr;  ///< The source if it is a recording.
};

ExportInput open_recording(const ExportOptions& options) {
  if (options.preset_given || !options.load.set.empty()) {
    throw InputError(options.scene + " has been simulated: remove --preset and --set");
  }
  auto recording = std::make_unique<RecordingReader>(options.scene);
  ExportInput input;
  input.recording = recording.get();
  input.name = std::filesystem::path(options.scene).stem().string();
  input.last = static_cast<int>(recording->frames()) - 1;
  input.source = std::move(recording);
  if (options.frames > input.last) {
    throw InputError("--frames " + std::to_string(options.frames) + ": " + options.scene +
                     " ends with frame " + std::to_string(input.last));
  }
  if (options.frames >= 0) input.last = options.frames;
  return input;
}

ExportInput open_scene(const ExportOptions& options) {
  Scene scene = scenes::load_scene(options.scene, options.load);
  ExportInput input;
  input.name = scene.name;
  input.last = last_frame(scene, options.frames, "--frames " + std::to_string(options.frames));
  input.source = make_simulation(std::move(scene));
  return input;
}

/// Throws InputError if the output is not a file that can be written.
void check_output(const ExportOptions& options) {
  if (!options.output.ends_with(".glb")) {
    throw InputError("-o " + options.output + ": expected a name that ends in .glb");
  }
  if (std::filesystem::is_directory(options.output)) {
    throw InputError("-o " + options.output + ": is a folder; give the name of a file");
  }
  if (60 % options.frames_per_s != 0) {
    throw InputError("--fps " + std::to_string(options.frames_per_s) +
                     ": expected a divisor of 60, such as 30, 20 or 15");
  }
}

std::string summary(const ExportOptions& options, const GltfSceneFigures& figures) {
  char text[200];
  std::snprintf(text, sizeof text,
                ", %.2f MB: %llu frames, %llu bodies, %llu meshes, %.1f %% of the poses as keys\n",
                static_cast<double>(figures.bytes) / 1e6,
                static_cast<unsigned long long>(figures.frames),
                static_cast<unsigned long long>(figures.bodies),
                static_cast<unsigned long long>(figures.meshes),
                50.0 * static_cast<double>(figures.keys) /
                    static_cast<double>(std::max<std::uint64_t>(1, figures.samples)));
  return options.output + text;
}

void write_figures(const ExportOptions& options, const GltfSceneFigures& figures) {
  const auto number = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  options.write_json(format_figures({{"/output", options.output},
                                     {"/frames", number(figures.frames)},
                                     {"/bodies", number(figures.bodies)},
                                     {"/meshes", number(figures.meshes)},
                                     {"/breaks", number(figures.breaks)},
                                     {"/samples", number(figures.samples)},
                                     {"/keys", number(figures.keys)},
                                     {"/bytes", number(figures.bytes)}}));
}

}  // namespace

WrittenRun write_run(const ExportOptions& options) {
  const ExportInput input =
      options.scene.ends_with(".take") ? open_recording(options) : open_scene(options);
  GltfSceneWriter writer(options.output, {.scene = input.name,
                                          .tolerance_m = options.tolerance_m,
                                          .tolerance_deg = options.tolerance_deg,
                                          .frames_per_s = options.frames_per_s});
  Progress progress("export " + input.name, input.last, options.quiet);
  FramesUntil frames(*input.source, input.last);
  std::optional<FramesAhead> ahead;
  if (threads() > 1) ahead.emplace(frames);
  FrameSink* const sinks[] = {&writer, &progress};
  const int stopped = pump_until_stopped(ahead ? static_cast<FrameSource&>(*ahead) : frames, sinks);
  ahead.reset();
  return {writer.figures(), input.name, input.recording ? input.recording->damage() : "", stopped};
}

int export_scene(const ExportOptions& options) {
  options.apply();
  check_output(options);
  const WrittenRun run = write_run(options);
  if (run.figures.frames == 0) {
    options.print("stopped before the first frame; nothing is written\n");
  } else {
    options.print((run.stopped == 0 ? "wrote " : "stopped; wrote the frames so far: ") +
                  summary(options, run.figures));
  }
  write_figures(options, run.figures);
  if (!run.damage.empty())
    throw InputError(options.scene + ": " + run.damage + "; the frames before were exported");
  return run.stopped;
}

}  // namespace sunder::app
