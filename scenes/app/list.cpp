// sunder list: the scenes, one line each.
#include "engine/io/figures.h"
#include "scenes/app/commands.h"

namespace sunder::app {
int list(const ListOptions& options) {
  if (options.keys) {
    options.say(scenes::key_reference());
    return 0;
  }
  Figures figures;
  std::size_t index = 0;
  for (const scenes::CatalogEntry& entry : scenes::catalog()) {
    options.say(entry.name + std::string(entry.name.size() < 14 ? 14 - entry.name.size() : 1, ' ') +
                entry.description + "\n");
    const std::string at = "/scenes/" + std::to_string(index++);
    figures[at + "/name"] = entry.name;
    figures[at + "/file"] = entry.file.string();
    figures[at + "/description"] = entry.description;
  }
  options.write_json(format_figures(figures));
  return 0;
}

}  // namespace sunder::app
