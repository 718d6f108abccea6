// The run that the commands export and view write.
#pragma once

#include <cstdint>
#include <string>

#include "engine/io/figures.h"
#include "scenes/app/commands.h"

namespace sunder::app {

/// A run that was written.
struct WrittenRun {
  std::uint64_t frames = 0;  ///< 0: nothing was written.
  std::string summary;       ///< Size and number of frames, for the user.
  Figures figures;
  std::string name;    ///< Name of the scene.
  int stopped = 0;     ///< Exit code: 0, or 128 plus the signal that stopped the run.
  std::string damage;  ///< Where a recording ends that is cut short; empty if it is not.
};

/// Writes the run of `options.scene` to options.output. Prints only progress, as that of `command`.
WrittenRun write_run(const ExportOptions& options, const std::string& command);

}  // namespace sunder::app
