// sunder render: a scene, or one stored frame, becomes a video or images.
#include <cstdio>
#include <limits>
#include <memory>

#include "engine/base/check.h"
#include "engine/io/figures.h"
#include "engine/io/frame_file.h"
#include "engine/io/state_hash.h"
#include "render/sinks.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  std::string output;
  std::string frames;
  std::string size = "1280x720";
  render::RenderOptions render;
};

struct Span {
  int first = 0;
  int last = std::numeric_limits<int>::max();
};

Span parse_frames(const std::string& text) {
  Span span;
  char rest = 0;
  if (!text.empty() && (std::sscanf(text.c_str(), "%d:%d%c", &span.first, &span.last, &rest) != 2 ||
                        span.first < 0 || span.last < span.first)) {
    throw InputError("--frames " + text + ": expected A:B, the first and the last frame, A <= B");
  }
  return span;
}

void parse_size(const std::string& text, render::RenderOptions& options) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &options.width, &options.height, &rest) != 2 ||
      options.width < 16 || options.height < 16 || options.width > 8192 || options.height > 8192 ||
      options.width % 2 != 0 || options.height % 2 != 0) {
    throw InputError("--size " + text +
                     ": expected WIDTHxHEIGHT, even numbers from 16 to 8192 (video needs even)");
  }
}

/// A source of the one frame that a file holds.
class StoredFrame final : public FrameSource {
 public:
  explicit StoredFrame(const std::string& file) : frame_(read_frame(file)) {}
  FramePtr next() override { return std::exchange(frame_, nullptr); }

 private:
  FramePtr frame_;
};

int draw(const Options& options) {
  options.common.apply();
  const Span span = parse_frames(options.frames);
  render::RenderOptions render_options = options.render;
  parse_size(options.size, render_options);

  std::unique_ptr<FrameSource> source;
  Span drawn;
  if (options.scene.scene.ends_with(".frame")) {
    source = std::make_unique<StoredFrame>(options.scene.scene);
    drawn.last = 0;
  } else {
    Scene scene = scenes::load_scene(options.scene.scene, options.scene.load);
    drawn = {span.first, last_frame(scene, span.last)};
    if (drawn.first > drawn.last) {
      throw InputError("--frames " + options.frames + ": the scene ends with frame " +
                       std::to_string(drawn.last));
    }
    source = make_simulation(std::move(scene));
  }
  render::Renderer renderer(render_options);
  options.common.say(renderer.description() + "\n");
  const auto pictures = render::make_picture_sink(options.output, renderer);
  FramesFrom shown(*pictures, static_cast<std::uint64_t>(drawn.first));
  FramesUntil frames(*source, drawn.last);
  Progress progress("render " + options.scene.scene, drawn.last, options.common.quiet);
  StateHash hash;
  FrameSink* const sinks[] = {&shown, &hash, &progress};
  pump(frames, sinks);
  options.common.say("wrote " + options.output + "\n");
  options.common.write_json(format_figures({{"/output", options.output},
                                            {"/gl", renderer.description()},
                                            {"/width", std::int64_t{render_options.width}},
                                            {"/height", std::int64_t{render_options.height}},
                                            {"/first_frame", std::int64_t{drawn.first}},
                                            {"/last_frame", std::int64_t{drawn.last}},
                                            {"/state_hash", hash.hex()}}));
  return 0;
}

}  // namespace

void add_render(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("render", "Off-screen video or images of a scene");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("SCENE", options->scene.scene,
                   "File or name of a scene, or a stored .frame file")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "X.mp4: video; X.png: the last frame; DIR/: a PNG a frame")
      ->required();
  command->add_option("--frames", options->frames, "Draw frames A to B, both included")
      ->type_name("A:B");
  command->add_option("--size", options->size, "Pixels")->type_name("WxH")->capture_default_str();
  command->add_option("--gl", options->render.gl, "auto | egl-device:N | egl-surfaceless | osmesa")
      ->capture_default_str();
  command->add_flag("--hud", options->render.hud, "Frame number, time and counts in the corner");
  add_changes(*command, options->scene.load);
  add_common(*command, options->common);
  command->callback([&chosen, options] { chosen = [options] { return draw(*options); }; });
}

}  // namespace sunder::app
