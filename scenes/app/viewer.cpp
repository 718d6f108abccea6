// sunder view: writes an HTML page that plays a run.
#include <cstdio>
#include <filesystem>

#include "engine/base/check.h"
#include "engine/io/figures.h"
#include "engine/io/file_ending.h"
#include "engine/io/unfinished_file.h"
#include "scenes/app/export.h"
#include "scenes/app/input_kind.h"
#include "scenes/report/view_page.h"

namespace sunder::app {
namespace {

/// Throws InputError for what can be told before the run.
void check_options(const ViewOptions& options) {
  if (!has_ending(options.output, ".html"))
    throw InputError("-o " + options.output + ": expected a name that ends in .html");
  if (std::filesystem::is_directory(options.output))
    throw InputError("-o " + options.output + ": is a folder; give the name of a file");
  scenes::check_three(options.three);
  if (input_kind(options.scene) != InputKind::kGlb) return;
  if (options.preset_given || !options.load.set.empty() || options.frames >= 0) {
    throw InputError(options.scene + " has been exported: remove --preset, --set and --frames");
  }
  scenes::check_run(options.scene);
}

int write_page(const ViewOptions& options, const scenes::ViewPage& page, const WrittenRun& run) {
  const std::uint64_t bytes = scenes::write_view_page(options.output, page);
  char size[60];
  std::snprintf(size, sizeof size, ", %.2f MB: open it in a browser\n",
                static_cast<double>(bytes) / 1e6);
  options.print((run.stopped == 0 ? "wrote " : "stopped; wrote the frames so far: ") +
                options.output + size);
  options.write_json(
      format_figures({{"/output", options.output}, {"/bytes", static_cast<std::int64_t>(bytes)}}));
  return run.stopped;
}

}  // namespace

int view(const ViewOptions& options) {
  options.apply();
  check_options(options);
  if (input_kind(options.scene) == InputKind::kGlb) {
    const std::filesystem::path run = options.scene;
    return write_page(options, {run.stem().string(), run, options.three}, {});
  }
  const UnfinishedFile file(options.output, ".glb");  // is never published
  ExportOptions exported = options;
  exported.output = file.path().string();
  const WrittenRun run = write_run(exported, "view");
  if (run.frames == 0) {
    options.print("stopped before the first frame; nothing is written\n");
    return run.stopped;
  }
  write_page(options, {run.name, file.path(), options.three}, run);
  if (!run.damage.empty())
    throw InputError(options.scene + ": " + run.damage + "; the page has the frames before");
  return run.stopped;
}

}  // namespace sunder::app
