// Scenes become simulations: our solver, our fracture, debris and dust around a scene, as the
// program has them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "engine/io/statistics.h"
#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder::scenes {

struct SimulationOptions {
  int threads = 0;  ///< For all that is computed from now on; 0: as it is, one a processor.
  /// Where breaks whose parts would not add up are kept, to look into by `sunder fracture`; empty:
  /// nowhere.
  std::filesystem::path cases_folder;
  /// Told, in a sentence, what the user should know, now and when the run is over; may be empty.
  std::function<void(const std::string& warning)> warn;
  /// Frames have an Inspection, for debug views; it takes time, and the run is the same.
  bool inspect = false;
};

/// A source of frames: frame 0 is the scene as given, then one every 1/60 s until the scene's
/// duration has passed. The same bits for any number of threads. Throws InputError for a planar
/// scene that needs a third dimension.
std::unique_ptr<FrameSource> make_simulation(Scene scene, const SimulationOptions& options = {});

/// What Statistics say about a run of the scene; the preset is that of its LoadOptions.
RunInfo run_info(const Scene& scene, const std::string& preset = "realtime");

}  // namespace sunder::scenes
