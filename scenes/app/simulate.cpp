// sunder simulate: a run without pictures, with its figures and its state hash.
#include <memory>

#include "engine/io/state_hash.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  int frames = -1;
};

int simulate(const Options& options) {
  options.common.apply();
  Scene scene = scenes::load_scene(options.scene.scene, options.scene.load);
  const int last = last_frame(scene, options.frames);
  Statistics statistics(run_info(scene, options.scene.load));
  Progress progress("simulate " + scene.name, last, options.common.quiet);
  StateHash hash;
  const auto simulation = make_simulation(std::move(scene));
  FramesUntil frames(*simulation, last);
  FrameSink* const sinks[] = {&statistics, &hash, &progress};
  pump(frames, sinks);
  options.common.say(statistics.table() + "state hash " + hash.hex() + "\n");
  options.common.write_json(statistics.json(hash.hex(), true));
  return 0;
}

}  // namespace

void add_simulate(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("simulate", "Run a scene without pictures");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene.scene, "File or name of a scene")->required();
  command->add_option("--frames", options->frames, "Stop after this many frames of 1/60 s")
      ->check(CLI::Range(1, 1000000));
  add_changes(*command, options->scene.load);
  add_common(*command, options->common);
  command->callback([&chosen, options] { chosen = [options] { return simulate(*options); }; });
}

}  // namespace sunder::app
