// sunder render: draws a scene, a recording or one stored frame as a video or images.
//
// Read first: render_scene(), which connects the sources and sinks above it.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/figures.h"
#include "engine/io/file_ending.h"
#include "engine/io/frame_file.h"
#include "engine/io/frames_ahead.h"
#include "engine/io/recording/recording.h"
#include "engine/io/statistics.h"
#include "render/camera.h"
#include "render/playback.h"
#include "render/sheet.h"
#include "render/sinks.h"
#include "render/view_mode.h"
#include "scenes/app/arguments.h"
#include "scenes/app/input_kind.h"
#include "scenes/app/run.h"
#include "scenes/app/run_notes.h"
#include "scenes/file/view.h"

namespace sunder::app {
namespace {

struct Span {
  int first = 0;
  int last = std::numeric_limits<int>::max();
};

/// Parses --frames "A:B", "A:", ":B" or "A".
Span parse_frames(const std::string& text) {
  if (text.empty()) return {};
  Span span;
  const char* const end = text.data() + text.size();
  const char* at = text.data();
  const auto number = [&](int& value) {  // leaves the value if there is no number
    if (at == end || *at == ':') return true;
    const auto [stop, error] = std::from_chars(at, end, value);
    at = stop;
    return error == std::errc() && value >= 0;
  };
  bool good = number(span.first);
  if (at == end) span.last = span.first;
  if (at != end) good = good && *at++ == ':' && text != ":" && number(span.last);
  if (!good || at != end || span.last < span.first) {
    throw InputError("--frames " + text +
                     ": expected A:B, the first and the last frame, A <= B; or A:, :B, or A alone");
  }
  return span;
}

/// A source of the one frame in a file.
class StoredFrame final : public FrameSource {
 public:
  explicit StoredFrame(const std::string& file) : frame_(read_frame(file)) {}
  int number() const { return static_cast<int>(frame_->index); }
  FramePtr next() override { return std::exchange(frame_, nullptr); }

 private:
  FramePtr frame_;
};

/// A source of another source's frames with the view of a camera.
class CameraSource final : public FrameSource {
 public:
  /// `is_recorded`: frames are stored ones, to whose views --set must be applied here.
  CameraSource(FrameSource& source, const RenderOptions& options, render::Camera& camera,
               bool is_recorded)
      : source_(source),
        options_(options),
        camera_(camera),
        changed_(is_recorded && !options.load.set.empty()) {}
  FramePtr next() override {
    const FramePtr frame = source_.next();
    if (!frame || (!changed_ && options_.view == "fixed")) return frame;
    auto seen = std::make_shared<Frame>(*frame);
    if (changed_) scenes::change_view(seen->view, options_.load.set, options_.scene);
    seen->view = camera_.at(*seen);
    return seen;
  }

 private:
  FrameSource& source_;
  const RenderOptions& options_;
  render::Camera& camera_;
  bool changed_;
};

/// A source of another source's frames that also gives each to a sink.
class TeeSource final : public FrameSource {
 public:
  TeeSource(FrameSource& source, FrameSink& sink) : source_(source), sink_(sink) {}
  FramePtr next() override {
    FramePtr frame = source_.next();
    if (frame) sink_.take(frame);
    return frame;
  }

 private:
  FrameSource& source_;
  FrameSink& sink_;
};

/// Hashes the states of frames, and counts how often they reached limits.
class StateRecorder final : public FrameSink {
 public:
  void take(const FramePtr& frame) override {
    states_.take(frame);
    limits_ += frame->report.limits;
    if (notes_) notes_->take(frame);
    limits_hit_ += frame->report.limits_hit;
  }
  /// Also takes the notes of a run of the scene.
  void note(const Scene& scene) { notes_.emplace(scene); }
  std::string hash() const { return states_.hex(); }
  std::string notes() const { return notes_ ? notes_->text() : ""; }
  std::string warning() const { return limits_warning(limits_, limits_hit_); }

 private:
  StateHash states_;
  LimitsHit limits_;
  std::uint32_t limits_hit_ = 0;
  std::optional<RunNotes> notes_;
};

/// Counts the frames that it passes on to another sink, which is finished only if there are any.
class CountingSink final : public FrameSink {
 public:
  explicit CountingSink(FrameSink& sink) : sink_(sink) {}
  void take(const FramePtr& frame) override {
    sink_.take(frame);
    ++taken_;
  }
  void finish() override {
    if (taken_ > 0) sink_.finish();
  }
  std::int64_t taken() const { return taken_; }

 private:
  FrameSink& sink_;
  std::int64_t taken_ = 0;
};

std::unique_ptr<render::Camera> camera_of(const std::string& spec) {
  if (has_ending(spec, ".toml")) return render::make_camera(scenes::load_view_keys(spec));
  return render::make_camera(spec);
}

/// The frames to draw and their source.
struct RenderInput {
  std::unique_ptr<FrameSource> source;
  Span drawn;
  int skipped = 0;                  ///< Number of frames before the first one of the source.
  RecordingReader* take = nullptr;  ///< The source if it is a recording.
  bool is_recorded = false;         ///< True for a recording or a stored frame.
};

/// Throws InputError if options would change the simulation of a recording or stored frame.
void check_recorded(const RenderOptions& options) {
  if (options.preset_given) {
    throw InputError(
        "--preset " + options.load.preset + ": " + options.scene +
        " has been simulated; only its view can be changed, by --view and --set view.KEY");
  }
}

/// Opens a stored frame. Throws InputError for options that need several frames.
RenderInput open_frame(const RenderOptions& options) {
  for (const auto& [is_given, flag] : {std::pair{!options.frames.empty(), "--frames"},
                                       {options.sheet > 1, "--sheet"},
                                       {options.speed != 1, "--speed"},
                                       {options.render.frames_per_s != 60, "--fps"}}) {
    if (is_given) throw InputError(options.scene + " is a single frame; remove " + flag);
  }
  auto frame = std::make_unique<StoredFrame>(options.scene);
  const int number = frame->number();
  return {std::move(frame), {number, number}, number, nullptr, true};
}

/// Opens the scene, recording or stored frame. `from_start`: a recording is read from frame 0 on.
RenderInput open(const RenderOptions& options, const Span& span, bool from_start,
                 StateRecorder& record) {
  RenderInput input;
  const InputKind kind = input_kind(options.scene);
  if (kind == InputKind::kGlb)
    throw InputError(options.scene + ": is an exported run; show it by sunder view");
  input.is_recorded = kind != InputKind::kScene;
  if (input.is_recorded) check_recorded(options);
  if (kind == InputKind::kFrame) return open_frame(options);
  int last = 0;
  if (kind == InputKind::kRecording) {
    auto take = std::make_unique<RecordingReader>(options.scene);
    input.take = take.get();
    last = static_cast<int>(input.take->frames()) - 1;
    input.source = std::move(take);
  } else {
    Scene scene = scenes::load_scene(options.scene, options.load);
    last = last_frame(scene, -1);
    record.note(scene);
    const render::ViewMode mode(options.render.view_mode);
    input.source = make_simulation(std::move(scene), {.inspect = mode.needs_inspection()});
  }
  input.drawn = {span.first, std::min(span.last, last)};
  if (input.drawn.first > input.drawn.last) {
    throw InputError("--frames " + options.frames + ": " + options.scene + " ends with frame " +
                     std::to_string(last));
  }
  if (input.take && !from_start) {
    input.skipped = span.first;
    input.take->seek(static_cast<std::uint32_t>(span.first));
  }
  return input;
}

std::unique_ptr<FrameSink> make_sink(const RenderOptions& options, render::Renderer& renderer,
                                     std::uint64_t first, std::uint64_t last) {
  if (options.sheet == 0) {
    return render::make_picture_sink(options.output, renderer, options.resume,
                                     options.render.frames_per_s,
                                     [] { return stop_signal() != 0; });
  }
  if (options.resume) throw InputError("--resume: a sheet cannot be resumed; remove the option");
  return render::make_sheet_sink(options.output, renderer, {first, last, options.sheet},
                                 !options.render.hud);
}

}  // namespace

int render_scene(const RenderOptions& options) {
  options.apply();
  const Span span = parse_frames(options.frames);
  render::RenderOptions render_options = options.render;
  parse_size(!options.size.empty() ? options.size
             : options.sheet > 0   ? "480x270"
                                   : "1280x720",
             render_options);

  const auto camera = camera_of(options.view);
  StateRecorder record;
  const RenderInput input = open(options, span, camera->depends_on_history(), record);
  const render::PlaybackRate pace{render_options.frames_per_s, options.speed};
  const std::uint64_t first = pace.first_picture(static_cast<std::uint64_t>(input.drawn.first));
  const std::uint64_t last = pace.last_picture(static_cast<std::uint64_t>(input.drawn.last));
  if (first > last) {
    throw InputError("--frames " + options.frames +
                     ": they contain no image at this --speed and --fps; give more frames");
  }
  render::Renderer renderer(render_options);
  options.print(renderer.description() + "\n");
  const auto pictures = make_sink(options, renderer, first, last);
  CountingSink counter(*pictures);
  FramesFrom from(counter, first);
  FramesUntil frames(*input.source, input.drawn.last - input.skipped);
  // Drawing and simulation alternate if there is only one thread.
  std::optional<FramesAhead> ahead;
  if (threads() > 1) ahead.emplace(frames);
  TeeSource tee(ahead ? static_cast<FrameSource&>(*ahead) : frames, record);
  render::ResampledSource paced(tee, pace, camera->depends_on_history() ? 0 : first);
  CameraSource seen(paced, options, *camera, input.is_recorded);
  Progress progress("render " + options.scene, static_cast<int>(last), options.quiet);
  FrameSink* const sinks[] = {&from, &progress};
  const int stopped = pump_until_stopped(seen, sinks);
  ahead.reset();
  if (const std::string warning = record.warning(); !warning.empty())
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  for (const std::string& warning : renderer.warnings())
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (counter.taken() == 0) {
    options.print("stopped before the first image; nothing is written\n");
  } else {
    options.print((stopped == 0 ? "wrote " : "stopped; wrote the images drawn so far: ") +
                  options.output + "\n" + record.notes());
  }
  options.write_json(format_figures({{"/output", options.output},
                                     {"/gl", renderer.description()},
                                     {"/width", std::int64_t{render_options.width}},
                                     {"/height", std::int64_t{render_options.height}},
                                     {"/first_frame", std::int64_t{input.drawn.first}},
                                     {"/last_frame", std::int64_t{input.drawn.last}},
                                     {"/pictures", counter.taken()},
                                     {"/state_hash", record.hash()}}));
  if (input.take && !input.take->damage().empty()) {
    throw InputError(options.scene + ": " + input.take->damage() +
                     "; the frames before were drawn");
  }
  return stopped;
}

}  // namespace sunder::app
