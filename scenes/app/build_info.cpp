#include "scenes/app/build_info.h"

namespace sunder::app {

BuildInfo build_info() {
  return {SUNDER_VERSION,  kCommit,      SUNDER_PROCESSOR,  SUNDER_BUILD_TYPE,
          SUNDER_COMPILER, SUNDER_FLAGS, SUNDER_SANITIZERS, SUNDER_HAS_PYTHON != 0};
}

Figures build_figures() {
  const BuildInfo info = build_info();
  return {{"/commit", info.commit},          {"/build/processor", info.processor},
          {"/build/type", info.type},        {"/build/compiler", info.compiler},
          {"/build/flags", info.flags},      {"/build/sanitizers", info.sanitizers},
          {"/build/python", info.has_python}};
}

std::string version_line() {
  const BuildInfo info = build_info();
  std::string line = "sunder " + info.version + " (";
  line += "commit " + info.commit;
  line += ", " + (info.processor.empty() ? "default instructions" : info.processor);
  line += ", " + info.type + ", " + info.compiler;
  if (!info.sanitizers.empty()) line += ", sanitizers " + info.sanitizers;
  return line + ")";
}

}  // namespace sunder::app
