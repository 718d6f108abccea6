#include "scenes/app/commands.h"

#include <cstdio>
#include <filesystem>

#include "engine/base/parallel.h"
#include "engine/io/bytes.h"

namespace sunder::app {

void CommonOptions::apply() const {
  constexpr int kMaxThreadsPerProcessor = 4;
  set_threads(0);
  const int processors = sunder::threads();
  set_threads(threads);
  if (threads > kMaxThreadsPerProcessor * processors) {
    std::fprintf(stderr, "warning: --threads %d is more than %d processors, which is slower\n",
                 threads, processors);
  }
}

void CommonOptions::print(const std::string& text) const {
  if (!quiet && json != "-") std::fputs(text.c_str(), stdout);
}

void CommonOptions::write_json(const std::string& text) const {
  if (json == "-") {
    std::fputs(text.c_str(), stdout);
  } else if (!json.empty()) {
    write_file(json, text);
  }
}

std::string goldens_folder() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const bool is_where_built =
      std::filesystem::equivalent(program.parent_path(), SUNDER_BUILD_FOLDER, ignored);
  return is_where_built ? SUNDER_GOLDENS_FOLDER : "tests/golden";
}

}  // namespace sunder::app
