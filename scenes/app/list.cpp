// sunder list: the scenes, one line each.
#include <memory>

#include "engine/io/figures.h"
#include "scenes/app/options.h"

namespace sunder::app {
namespace {

struct Options {
  CommonOptions common;
  bool keys = false;
};

int list(const Options& options) {
  if (options.keys) {
    options.common.say(scenes::key_reference());
    return 0;
  }
  Figures figures;
  std::size_t index = 0;
  for (const scenes::CatalogEntry& entry : scenes::catalog()) {
    options.common.say(entry.name +
                       std::string(entry.name.size() < 14 ? 14 - entry.name.size() : 1, ' ') +
                       entry.description + "\n");
    const std::string at = "/scenes/" + std::to_string(index++);
    figures[at + "/name"] = entry.name;
    figures[at + "/file"] = entry.file.string();
    figures[at + "/description"] = entry.description;
  }
  options.common.write_json(format_figures(figures));
  return 0;
}

}  // namespace

void add_list(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("list", "The scenes, one line each");
  const auto options = std::make_shared<Options>();
  command->add_flag("--keys", options->keys, "Every key of a scene file instead, as Markdown");
  add_common(*command, options->common);
  command->callback([&chosen, options] { chosen = [options] { return list(*options); }; });
}

}  // namespace sunder::app
