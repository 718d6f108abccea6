// Files of a run in the folder of a study: runs/SCENE/POINT-SEED.json has the results, which are
// the same on every machine, and times/SCENE/POINT-SEED.json has the times.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/trade/study.h"

namespace sunder::scenes {

/// Writes the file of times, then that of results, each atomically. Throws FileError.
void write_run(const std::filesystem::path& folder, const StudyRun& run, const Ran& ran);

/// A run as read from its files.
struct StoredRun {
  Ran ran;
  std::string missing;   ///< Reason why the run must be done; empty if it is done.
  bool damaged = false;  ///< True if a file exists that is unreadable or belongs to another run.
};
/// Reads the files of a run.
StoredRun read_run(const std::filesystem::path& folder, const StudyRun& run);

}  // namespace sunder::scenes
