// sunder golden: pictures that must not change unasked. A golden is a stored frame and the picture
// it gave: NAME.frame, NAME.png and NAME.json in tests/golden.
//
// Read first: test(). `accept` is the one way to change a baseline.
#include <cstdio>
#include <memory>

#include "engine/base/check.h"
#include "engine/io/frame_file.h"
#include "render/renderer.h"
#include "scenes/app/golden_file.h"
#include "scenes/app/golden_report.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::vector<std::string> names;
  std::string folder = SUNDER_GOLDENS_FOLDER;
  std::string out = "out/golden";
  std::string gl = "auto";
  std::string scene;
  scenes::LoadOptions load;
  int frame = 0;
};

render::Image draw(const Options& options, const Golden& golden, std::string& renderer_name) {
  render::RenderOptions render_options;
  render_options.width = golden.width;
  render_options.height = golden.height;
  render_options.gl = options.gl;
  render::Renderer renderer(render_options);
  renderer_name = renderer.description();
  return renderer.draw(*read_frame(golden.frame_file()));
}

GoldenResult compare_with_baseline(const Options& options, const std::string& name) {
  GoldenResult result;
  result.golden = read_golden(options.folder, name);
  result.actual = draw(options, result.golden, result.renderer);
  if (!fs::exists(result.golden.picture_file())) {
    result.verdict = "no baseline: look at the picture, then run: sunder golden accept " + name;
    return result;
  }
  result.baseline = render::read_png(result.golden.picture_file());
  result.difference = render::compare(result.baseline, result.actual);
  result.passed = result.difference.passes(result.golden.thresholds);
  char text[200];
  std::snprintf(text, sizeof text, "%s: FLIP mean %.4f of %.4f, worst window %d of %d pixels",
                result.passed ? "similar" : "different", result.difference.flip_mean,
                result.golden.thresholds.flip_mean, result.difference.worst_window_pixels,
                result.golden.thresholds.window_pixels);
  result.verdict = result.difference.same_bytes ? "same bytes" : text;
  return result;
}

std::vector<GoldenResult> compare_all(const Options& options) {
  std::vector<GoldenResult> results;
  const auto names = options.names.empty() ? golden_names(options.folder) : options.names;
  for (const std::string& name : names) {
    results.push_back(compare_with_baseline(options, name));
    const GoldenResult& result = results.back();
    options.common.say((result.passed ? "pass " : "FAIL ") + name + ": " + result.verdict + "\n");
    if (!result.passed) {
      fs::create_directories(options.out);
      const fs::path picture = fs::path(options.out) / (name + ".png");
      render::write_png(picture, result.actual);
      options.common.say("     what was drawn: " + picture.string() + "\n");
    }
  }
  return results;
}

int failures(const std::vector<GoldenResult>& results) {
  int count = 0;
  for (const GoldenResult& result : results) count += result.passed ? 0 : 1;
  return count;
}

int test(const Options& options) {
  const std::vector<GoldenResult> results = compare_all(options);
  options.common.write_json(format_results(results));
  return failures(results) == 0 ? 0 : 1;
}

int report(const Options& options) {
  const std::vector<GoldenResult> results = compare_all(options);
  fs::create_directories(options.out);
  const fs::path page = fs::path(options.out) / "report.html";
  write_text(page.string(), golden_page(results));
  options.common.say("wrote " + page.string() + "\n");
  options.common.write_json(format_results(results));
  return failures(results) == 0 ? 0 : 1;
}

int accept(const Options& options) {
  for (const std::string& name : options.names) {
    Golden golden = read_golden(options.folder, name);
    const render::Image picture = draw(options, golden, golden.renderer);
    golden.cpu = cpu_name();
    golden.hash = pixel_hash(picture);
    render::write_png(golden.picture_file(), picture);
    write_golden(golden);
    options.common.say("accepted " + name + ", " + golden.hash + "\n");
  }
  return 0;
}

/// Stores a frame of a scene as the subject of a golden; its picture still has to be accepted.
int record(const Options& options) {
  options.common.apply();
  const std::string& name = options.names.front();
  Scene scene = scenes::load_scene(options.scene, options.load);
  const int last = last_frame(scene, options.frame);
  Progress progress("record " + scene.name, last, options.common.quiet);
  const auto simulation = make_simulation(std::move(scene));
  FramePtr frame;
  while (FramePtr next = simulation->next()) {
    frame = next;
    progress.take(frame);
    if (frame->index == static_cast<std::uint64_t>(last)) break;
  }
  Golden golden;
  golden.folder = options.folder;
  golden.name = name;
  golden.command = "sunder golden record " + name + " " + options.scene + " " +
                   std::to_string(last) + " && sunder golden accept " + name;
  fs::create_directories(options.folder);
  write_frame(golden.frame_file(), without_unused_meshes(*frame));
  write_golden(golden);
  options.common.say("recorded " + golden.frame_file().string() +
                     "; look at it, then: sunder golden accept " + name + "\n");
  return 0;
}

}  // namespace

void add_golden(CLI::App& app, Command& chosen) {
  CLI::App* golden = app.add_subcommand("golden", "Golden-image regression");
  golden->require_subcommand(1);
  const auto add = [&](const char* name, const char* help, int (*work)(const Options&)) {
    CLI::App* command = golden->add_subcommand(name, help);
    const auto options = std::make_shared<Options>();
    CLI::Option* names = command->add_option("NAME", options->names, "Goldens; all by default");
    command->add_option("--folder", options->folder, "Where goldens lie")->capture_default_str();
    command->add_option("--gl", options->gl, "As in sunder render")->capture_default_str();
    add_common(*command, options->common);
    command->callback([&chosen, options, work] { chosen = [=] { return work(*options); }; });
    return std::tuple{command, options, names};
  };
  const auto add_out = [](const auto& command) {
    std::get<0>(command)
        ->add_option("--out", std::get<1>(command)->out, "Where new files go")
        ->capture_default_str();
  };
  add_out(add("test", "Draw the stored frames and compare with the baselines", test));
  add_out(add("report", "As test, and write report.html with all pictures", report));
  std::get<2>(add("accept", "Make what is drawn now the baseline", accept))->required();
  const auto recording = add("record", "Store a frame of a scene as a golden's subject", record);
  std::get<2>(recording)->required()->expected(1);
  CLI::App* command = std::get<0>(recording);
  Options& options = *std::get<1>(recording);
  command->add_option("SCENE", options.scene, "File or name of a scene")->required();
  command->add_option("FRAME", options.frame, "Which frame")
      ->required()
      ->check(CLI::Range(0, 1000000));
  add_changes(*command, options.load);
}

}  // namespace sunder::app
