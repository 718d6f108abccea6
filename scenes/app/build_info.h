// Facts about the build of this program.
#pragma once

#include <string>

#include "engine/io/figures.h"

namespace sunder::app {

/// The commit that the program was built from; a source that every build writes defines it.
extern const char* const kCommit;

struct BuildInfo {
  std::string version;      ///< As in "1.0.0".
  std::string commit;       ///< First 12 digits, and "+changes" if sources differ; or "unknown".
  std::string processor;    ///< Instruction set, as in "x86-64-v3"; empty: the compiler's default.
  std::string type;         ///< CMake's build type, as in "Release".
  std::string compiler;     ///< As in "GNU 12.2.0".
  std::string flags;        ///< Options of the compiler that the user or the build type sets.
  std::string sanitizers;   ///< Empty if there are none.
  bool has_python = false;  ///< True if the Python module was built with the program.
};

BuildInfo build_info();

/// Returns `commit` and `build`.
Figures build_figures();

/// Returns the line of --version: "sunder 1.0.0 (commit ..., x86-64-v3, Release, GNU 12.2.0)".
std::string version_line();

}  // namespace sunder::app
