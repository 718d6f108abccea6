#include "scenes/app/build_info.h"

namespace sunder::app {

BuildInfo build_info() {
  return {SUNDER_VERSION,  SUNDER_COMMIT,     SUNDER_PROCESSOR,      SUNDER_BUILD_TYPE,
          SUNDER_COMPILER, SUNDER_SANITIZERS, SUNDER_HAS_PYTHON != 0};
}

std::string version_line() {
  const BuildInfo info = build_info();
  std::string line = "sunder " + info.version + " (";
  line += info.commit.empty() ? "commit unknown" : "commit " + info.commit;
  line += ", " + (info.processor.empty() ? "default instructions" : info.processor);
  line += ", " + info.type + ", " + info.compiler;
  if (!info.sanitizers.empty()) line += ", sanitizers " + info.sanitizers;
  return line + ")";
}

}  // namespace sunder::app
