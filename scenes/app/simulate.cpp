// sunder simulate: a run without pictures, with its figures and its state hash.
#include "engine/io/state_hash.h"
#include "scenes/app/run.h"

namespace sunder::app {
int simulate(const SimulateOptions& options) {
  options.apply();
  Scene scene = scenes::load_scene(options.scene, options.load);
  const int last = last_frame(scene, options.frames);
  Statistics statistics(run_info(scene, options.load));
  Progress progress("simulate " + scene.name, last, options.quiet);
  StateHash hash;
  const auto simulation = make_simulation(std::move(scene));
  FramesUntil frames(*simulation, last);
  FrameSink* const sinks[] = {&statistics, &hash, &progress};
  pump(frames, sinks);
  options.say(statistics.table() + "state hash " + hash.hex() + "\n");
  options.write_json(statistics.json(hash.hex(), true));
  return 0;
}

}  // namespace sunder::app
