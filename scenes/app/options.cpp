#include "scenes/app/options.h"

#include <cstdio>
#include <cstring>

#include "engine/base/parallel.h"
#include "engine/io/bytes.h"

namespace sunder::app {

void CommonOptions::apply() const { set_threads(threads); }

void CommonOptions::say(const std::string& text) const {
  if (!quiet && json != "-") std::fputs(text.c_str(), stdout);
}

void CommonOptions::write_json(const std::string& text) const {
  if (json == "-") {
    std::fputs(text.c_str(), stdout);
  } else if (!json.empty()) {
    write_text(json, text);
  }
}

void add_common(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "Threads; 0 for one per processor")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--quiet", options.quiet, "Print nothing but errors");
  command.add_option("--json", options.json, "Write figures as JSON to a file, or - for stdout");
}

void add_changes(CLI::App& command, scenes::LoadOptions& load) {
  command.add_option("--preset", load.preset, "Speed against accuracy: draft | realtime")
      ->capture_default_str();
  command.add_option("--set", load.set, "Change a key of the scene: key=value, as often as wanted")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false);
}

void write_text(const std::string& path, const std::string& text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  write_file(path, bytes);
}

}  // namespace sunder::app
