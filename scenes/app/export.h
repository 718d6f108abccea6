// The run that the commands export and view write.
#pragma once

#include <string>

#include "engine/io/scene_export/gltf_scene_writer.h"
#include "scenes/app/commands.h"

namespace sunder::app {

/// A run that was written.
struct WrittenRun {
  GltfSceneFigures figures;  ///< Without frames if nothing was written.
  std::string name;          ///< Name of the scene.
  std::string damage;        ///< Where a recording ends that is cut short; empty if it is not.
  int stopped = 0;           ///< Exit code: 0, or 128 plus the signal that stopped the run.
};

/// Writes the run of `options.scene` to options.output, and prints progress alone.
WrittenRun write_run(const ExportOptions& options);

}  // namespace sunder::app
