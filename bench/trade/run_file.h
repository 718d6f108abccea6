// A run's files in the folder of a study: runs/SCENE/POINT-SEED.json, which holds what counts and
// is the same whoever makes it, and times/SCENE/POINT-SEED.json beside it.
#pragma once

#include <filesystem>
#include <string>

#include "bench/trade/study.h"

namespace sunder::bench {

/// Both files, each whole or not at all; a result that is there has its times. Throws FileError.
void write_run(const std::filesystem::path& folder, const StudyRun& run, const Ran& ran);

/// A run as it was found.
struct StoredRun {
  Ran ran;
  std::string missing;   ///< Why it has to be done; empty: it is done.
  bool damaged = false;  ///< A file is there, but it is not of this run.
};
StoredRun read_run(const std::filesystem::path& folder, const StudyRun& run);

}  // namespace sunder::bench
