// sunder render: a scene, a take or one stored frame becomes a video or images.
#include <charconv>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/check.h"
#include "engine/io/figures.h"
#include "engine/io/frame_file.h"
#include "engine/io/statistics.h"
#include "engine/io/take/take.h"
#include "render/sinks.h"
#include "scenes/app/arguments.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

struct Span {
  int first = 0;
  int last = std::numeric_limits<int>::max();
};

/// "A:B", "A:", ":B" or "A".
Span parse_frames(const std::string& text) {
  if (text.empty()) return {};
  Span span;
  const char* const end = text.data() + text.size();
  const char* at = text.data();
  const auto number = [&](int& value) {  // none keeps it
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

/// A source of the one frame that a file holds.
class StoredFrame final : public FrameSource {
 public:
  explicit StoredFrame(const std::string& file) : frame_(read_frame(file)) {}
  FramePtr next() override { return std::exchange(frame_, nullptr); }

 private:
  FramePtr frame_;
};

/// What another source gives, looked at as the first of it is with the user's changes.
class LookedAt final : public FrameSource {
 public:
  LookedAt(std::unique_ptr<FrameSource> source, const RenderOptions& options)
      : source_(std::move(source)), options_(options) {}
  FramePtr next() override {
    const FramePtr frame = source_->next();
    if (!frame || options_.load.set.empty()) return frame;
    if (!view_) {
      view_ = frame->view;
      scenes::change_view(*view_, options_.load.set, options_.scene);
    }
    auto seen = std::make_shared<Frame>(*frame);
    seen->view = *view_;
    return seen;
  }

 private:
  std::unique_ptr<FrameSource> source_;
  const RenderOptions& options_;
  std::optional<View> view_;
};

/// What is drawn, and where it comes from.
struct Shown {
  std::unique_ptr<FrameSource> source;
  Span drawn;
  int skipped = 0;             ///< Frames that the source does not give.
  TakeReader* take = nullptr;  ///< What the source plays, if it does.
};

Shown open(const RenderOptions& options, const Span& span) {
  const bool is_frame = options.scene.ends_with(".frame"),
             is_take = options.scene.ends_with(".take");
  if ((is_frame || is_take) && options.preset_given) {
    throw InputError("--preset " + options.load.preset + ": " + options.scene +
                     " has been simulated; only how it is looked at can change, by --set view.KEY");
  }
  if (is_frame)
    return {std::make_unique<LookedAt>(std::make_unique<StoredFrame>(options.scene), options),
            {0, 0}};
  Shown shown;
  int last = 0;
  if (is_take) {
    auto take = std::make_unique<TakeReader>(options.scene);
    shown.take = take.get();
    last = static_cast<int>(shown.take->frames()) - 1;
    shown.source = std::make_unique<LookedAt>(std::move(take), options);
  } else {
    Scene scene = scenes::load_scene(options.scene, options.load);
    last = last_frame(scene, -1);
    shown.source = make_simulation(std::move(scene));
  }
  shown.drawn = {span.first, std::min(span.last, last)};
  if (shown.drawn.first > shown.drawn.last) {
    throw InputError("--frames " + options.frames + ": " + options.scene + " ends with frame " +
                     std::to_string(last));
  }
  if (shown.take) {
    shown.skipped = span.first;
    shown.take->seek(static_cast<std::uint32_t>(span.first));
  }
  return shown;
}

}  // namespace

int render_scene(const RenderOptions& options) {
  options.apply();
  const Span span = parse_frames(options.frames);
  render::RenderOptions render_options = options.render;
  parse_size(options.size, render_options);

  const Shown shown = open(options, span);
  render::Renderer renderer(render_options);
  options.say(renderer.description() + "\n");
  const auto pictures = render::make_picture_sink(options.output, renderer, options.resume);
  FramesFrom from(*pictures, static_cast<std::uint64_t>(shown.drawn.first));
  FramesUntil frames(*shown.source, shown.drawn.last - shown.skipped);
  Progress progress("render " + options.scene, shown.drawn.last, options.quiet);
  StateHash hash;
  FrameSink* const sinks[] = {&from, &hash, &progress};
  const int stopped = pump_until_stopped(frames, sinks);
  options.say((stopped == 0 ? "wrote " : "stopped; kept what was drawn: ") + options.output + "\n");
  options.write_json(format_figures({{"/output", options.output},
                                     {"/gl", renderer.description()},
                                     {"/width", std::int64_t{render_options.width}},
                                     {"/height", std::int64_t{render_options.height}},
                                     {"/first_frame", std::int64_t{shown.drawn.first}},
                                     {"/last_frame", std::int64_t{shown.drawn.last}},
                                     {"/state_hash", hash.hex()}}));
  if (shown.take && !shown.take->damage().empty()) {
    throw InputError(options.scene + ": " + shown.take->damage() + "; what was before is drawn");
  }
  return stopped;
}

}  // namespace sunder::app
