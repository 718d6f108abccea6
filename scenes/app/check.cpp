// sunder list: lists the scenes. sunder check: loads and validates scenes without running them.
#include "engine/base/check.h"

#include <cstdio>

#include "engine/io/figures.h"
#include "scenes/app/commands.h"
#include "scenes/file/error_list.h"
#include "scenes/make_simulation.h"

namespace sunder::app {

int list(const ListOptions& options) {
  if (options.keys) {
    options.print(scenes::key_reference());
    return 0;
  }
  Figures figures;
  std::size_t index = 0;
  for (const scenes::CatalogEntry& entry : scenes::catalog()) {
    if (options.quiet && options.json != "-") std::printf("%s\n", entry.name.c_str());
    options.print(entry.name +
                  std::string(entry.name.size() < 14 ? 14 - entry.name.size() : 1, ' ') +
                  entry.description + "\n");
    const std::string at = "/scenes/" + std::to_string(index++);
    figures[at + "/name"] = entry.name;
    figures[at + "/file"] = entry.file.string();
    figures[at + "/description"] = entry.description;
  }
  options.write_json(format_figures(figures));
  return 0;
}

namespace {

/// Prints the mistakes of a scene, and adds them to its figures.
void report_errors(const std::vector<std::string>& errors, const std::string& at,
                   Figures& figures) {
  figures[at + "/good"] = false;
  figures[at + "/error"] = errors.front();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::fprintf(stderr, "error: %s\n", errors[i].c_str());
    figures[at + "/errors/" + std::to_string(i)] = errors[i];
  }
}

}  // namespace

// Checks all scenes, also after one with an error.
int check(const CheckOptions& options) {
  Figures figures;
  int wrong = 0;
  for (std::size_t i = 0; i < options.scenes.size(); ++i) {
    const std::string& name = options.scenes[i];
    const std::string at = "/scenes/" + std::to_string(i);
    figures[at + "/scene"] = name;
    try {
      const Scene scene = scenes::load_scene(name, options.load);
      std::size_t convexes = 0;
      for (const Solid& solid : scene.solids) convexes += solid.compound.convexes.size();
      options.print(name + ": good (" + std::to_string(scene.solids.size()) + " solids of " +
                    std::to_string(convexes) + " convexes, " +
                    std::to_string(scene.balls.size() + scene.shots.size()) + " balls)\n");
      for (const std::string& warning : scenes::run_info(scene, options.load.preset).warnings)
        std::fprintf(stderr, "warning: %s: %s\n", name.c_str(), warning.c_str());
      figures[at + "/good"] = true;
      figures[at + "/solids"] = static_cast<std::int64_t>(scene.solids.size());
      figures[at + "/convexes"] = static_cast<std::int64_t>(convexes);
    } catch (const scenes::InputErrors& errors) {
      report_errors(errors.all(), at, figures);
      ++wrong;
    } catch (const InputError& error) {
      report_errors({error.what()}, at, figures);
      ++wrong;
    }
  }
  options.write_json(format_figures(figures));
  return wrong == 0 ? 0 : 2;
}

}  // namespace sunder::app
