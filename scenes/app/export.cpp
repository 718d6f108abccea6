// sunder export: writes a run or a recording as files for other programs.
//
// Read first: export_scene() and write_run().
#include "scenes/app/export.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/file_ending.h"
#include "engine/io/frames_ahead.h"
#include "engine/io/recording/recording.h"
#include "engine/io/scene_export/gltf_scene_writer.h"
#include "engine/io/scene_export/mesh_sequence_writer.h"
#include "scenes/app/input_kind.h"
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

ExportInput open_run(const ExportOptions& options) {
  const InputKind kind = input_kind(options.scene);
  if (kind == InputKind::kRecording) return open_recording(options);
  if (kind == InputKind::kScene) return open_scene(options);
  throw InputError(options.scene +
                   (kind == InputKind::kFrame ? ": is a single frame" : ": has been exported") +
                   "; give a scene or a recording");
}

bool is_glb(const ExportOptions& options) { return has_ending(options.output, ".glb"); }

/// Throws InputError if the output is neither a GLB nor a folder, or options are for the other.
void check_output(const ExportOptions& options) {
  const std::string name = "-o " + options.output;
  const bool is_folder = std::filesystem::is_directory(options.output);
  if (!is_glb(options) && !is_folder && !options.output.ends_with("/")) {
    throw InputError(name + ": expected X.glb, or a folder, DIR/, for a mesh file per frame");
  }
  if (is_glb(options) && is_folder) {
    throw InputError(name + ": is a folder; give the name of a file");
  }
  if (is_glb(options) && !options.format.empty())
    throw InputError("--format " + options.format + ": is for a folder, -o DIR/");
  if (!is_glb(options) && (options.tolerance_m || options.tolerance_deg)) {
    throw InputError(name + ": mesh files have every frame; remove --tolerance and --angle");
  }
  if (!is_glb(options) && options.particles)
    throw InputError(name + ": mesh files have no debris; remove --particles");
  if (60 % options.frames_per_s != 0) {
    throw InputError("--fps " + std::to_string(options.frames_per_s) +
                     ": expected a divisor of 60, such as 30, 20 or 15");
  }
}

std::string megabytes_of(std::uint64_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

/// A sink that writes the files, with what is said of them at the end.
class Exporter : public FrameSink {
 public:
  virtual std::uint64_t frames() const = 0;
  virtual std::string summary() const = 0;
  virtual Figures figures() const = 0;
};

class GltfExporter final : public Exporter {
 public:
  GltfExporter(const ExportOptions& options, const std::string& name)
      : writer_(options.output, gltf_options(options, name)) {}
  void take(const FramePtr& frame) override { writer_.take(frame); }
  void finish() override { writer_.finish(); }
  std::uint64_t frames() const override { return writer_.figures().frames; }
  std::string summary() const override {
    const GltfSceneFigures& all = writer_.figures();
    return megabytes_of(all.bytes) + ": " + std::to_string(all.frames) + " frames, " +
           std::to_string(all.bodies) + " bodies, " + std::to_string(all.meshes) + " meshes";
  }
  Figures figures() const override {
    const GltfSceneFigures& all = writer_.figures();
    const auto number = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
    return {{"/frames", number(all.frames)}, {"/bodies", number(all.bodies)},
            {"/meshes", number(all.meshes)}, {"/breaks", number(all.breaks)},
            {"/chips", number(all.chips)},   {"/samples", number(all.samples)},
            {"/keys", number(all.keys)},     {"/bytes", number(all.bytes)}};
  }

 private:
  static GltfSceneOptions gltf_options(const ExportOptions& options, const std::string& name) {
    GltfSceneOptions made;
    made.scene = name;
    made.tolerance_m = options.tolerance_m.value_or(made.tolerance_m);
    made.tolerance_deg = options.tolerance_deg.value_or(made.tolerance_deg);
    made.frames_per_s = options.frames_per_s;
    made.particles = options.particles;
    return made;
  }
  GltfSceneWriter writer_;
};

class SequenceExporter final : public Exporter {
 public:
  explicit SequenceExporter(const ExportOptions& options)
      : writer_(options.output, sequence_format(options.format.empty() ? "obj" : options.format),
                options.frames_per_s) {}
  void take(const FramePtr& frame) override { writer_.take(frame); }
  void finish() override { writer_.finish(); }
  std::uint64_t frames() const override { return writer_.frames(); }
  std::string summary() const override {
    return megabytes_of(writer_.bytes()) + ": " + std::to_string(writer_.frames()) + " frames";
  }
  Figures figures() const override {
    return {{"/frames", static_cast<std::int64_t>(writer_.frames())},
            {"/bytes", static_cast<std::int64_t>(writer_.bytes())}};
  }

 private:
  MeshSequenceWriter writer_;
};

/// Counts how often the frames reached limits.
class LimitsCounter final : public FrameSink {
 public:
  void take(const FramePtr& frame) override {
    limits_ += frame->report.limits;
    hit_ += frame->report.limits_hit;
  }
  /// Prints a warning if any limit was reached.
  void finish() override {
    if (const std::string warning = limits_warning(limits_, hit_); !warning.empty())
      std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }

 private:
  LimitsHit limits_;
  std::uint32_t hit_ = 0;
};

std::unique_ptr<Exporter> make_exporter(const ExportOptions& options, const std::string& name) {
  if (is_glb(options)) return std::make_unique<GltfExporter>(options, name);
  return std::make_unique<SequenceExporter>(options);
}

}  // namespace

WrittenRun write_run(const ExportOptions& options, const std::string& command) {
  const ExportInput input = open_run(options);
  const std::unique_ptr<Exporter> exporter = make_exporter(options, input.name);
  Progress progress(command + " " + input.name, input.last, options.quiet);
  FramesUntil frames(*input.source, input.last);
  std::optional<FramesAhead> ahead;
  if (threads() > 1) ahead.emplace(frames);
  LimitsCounter limits;
  std::vector<FrameSink*> sinks = {exporter.get(), &progress};
  if (!input.recording) sinks.push_back(&limits);  // recordings do not have the counts
  const int stopped = pump_until_stopped(ahead ? static_cast<FrameSource&>(*ahead) : frames, sinks);
  ahead.reset();
  return {exporter->frames(),
          exporter->summary(),
          exporter->figures(),
          input.name,
          stopped,
          input.recording ? input.recording->damage() : ""};
}

int export_scene(const ExportOptions& options) {
  options.apply();
  check_output(options);
  WrittenRun run = write_run(options, "export");
  if (run.frames == 0) {
    options.print("stopped before the first frame; nothing is written\n");
  } else {
    options.print((run.stopped == 0 ? "wrote " : "stopped; wrote the frames so far: ") +
                  options.output + ", " + run.summary + "\n");
  }
  run.figures["/output"] = options.output;
  options.write_json(format_figures(run.figures));
  if (!run.damage.empty())
    throw InputError(options.scene + ": " + run.damage + "; the frames before were exported");
  return run.stopped;
}

}  // namespace sunder::app
