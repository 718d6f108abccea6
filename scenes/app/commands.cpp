#include "scenes/app/commands.h"

#include <cstdio>
#include <filesystem>

#include "engine/base/parallel.h"
#include "engine/io/bytes.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

fs::path program_file() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored);
}

}  // namespace

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

std::string installed_goldens_folder() {
  return (program_file().parent_path().parent_path() / "share/sunder/golden").string();
}

std::string own_goldens_folder() { return "tests/golden"; }

std::string goldens_folder() {
  const std::string own = own_goldens_folder();
  const std::string installed = installed_goldens_folder();
  std::error_code ignored;
  for (fs::directory_iterator file(own, ignored), end; !ignored && file != end; ++file)
    if (file->path().extension() == ".json") return own;
  return fs::is_directory(installed, ignored) ? installed : own;
}

std::string hashes_file() {
  const std::string own = own_goldens_folder() + "/hashes.txt";
  std::error_code ignored;
  return fs::exists(own, ignored) ? own : goldens_folder() + "/hashes.txt";
}

std::string place_text(const std::string& place) {
  const auto full = [](const std::string& path) {
    return fs::absolute(path).lexically_normal().string();
  };
  const std::string installed = installed_goldens_folder();
  const bool is_default = place == goldens_folder() || place == hashes_file();
  if (!is_default || !place.starts_with(installed)) return full(place);
  return full(place) + ", installed with the program; there is no " +
         full(own_goldens_folder() + place.substr(installed.size()));
}

}  // namespace sunder::app
