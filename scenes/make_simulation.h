// Makes worlds and simulations of scenes, with the program's solver, fracture, debris and dust.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/io/statistics.h"
#include "engine/model/frame.h"
#include "engine/model/scene.h"
#include "engine/world/world.h"

namespace sunder::scenes {

/// Options of a run that do not change its results.
struct SimulationOptions {
  int threads = 0;  ///< Threads of the simulation; 0: as many as the process has set.
  /// Folder for case files of breaks whose parts do not sum to the volume before, for
  /// `sunder fracture`; empty: none are written.
  std::filesystem::path cases_folder = {};
  /// Called with each warning to the user, a sentence, now and at the end of the run; may be empty.
  std::function<void(const std::string& warning)> warn = {};
  /// True if frames have an Inspection, for debug views. This takes time; the run is unchanged.
  bool inspect = false;
  /// True if FrameReport::stage_loops is measured, on one thread; the run is unchanged.
  bool count_loops = false;
};

/// A run up to a saved state, as the program that saves it knows it.
struct RunSoFar {
  /// Convexes that breaks left whole, and their volume: counted in the warning at the end.
  std::uint64_t failed = 0;
  double failed_m3 = 0;
  std::vector<std::byte> totals;  ///< Anything else that the program keeps with the state.
};

/// Returns a world that the caller advances. Throws InputError for a planar scene that needs a
/// third dimension.
World make_world(Scene scene, const SimulationOptions& options = {});
/// Returns the state of a world as bytes: compressed, and with a sum that tells damage. Worlds in
/// equal states have equal bytes. Throws InputError for a planar scene.
std::vector<std::byte> save_world(const World& world, const RunSoFar& so_far = {});
/// Returns a world in the state that save_world() of the same version of the program has returned,
/// in this or another process; it goes on with the same bits. Of `options`, `cases_folder`,
/// `threads` and `warn` are used. Sets `so_far`, if it is given, to what was saved with the world.
/// Throws InputError, which begins with `name`, for other bytes.
World restore_world(std::span<const std::byte> bytes, const SimulationOptions& options = {},
                    const std::string& name = "restore_world()", RunSoFar* so_far = nullptr);
/// Returns a source of frames: frame 0 is the scene as given, then one every 1/60 s until the
/// scene's duration has passed. Frames are bit-identical for any number of threads. Throws
/// InputError for a planar scene that needs a third dimension.
std::unique_ptr<FrameSource> make_simulation(Scene scene, const SimulationOptions& options = {});

/// Returns the description of a run for Statistics; `preset` is that of the scene's LoadOptions.
RunInfo run_info(const Scene& scene, const std::string& preset = "realtime");

}  // namespace sunder::scenes
