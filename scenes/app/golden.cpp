// sunder golden: pictures that must not change unasked. A golden is a stored frame and the picture
// it gave: NAME.frame, NAME.png and NAME.json in tests/golden.
//
// Read first: golden_test(). `accept` is the one way to change a baseline.
#include <cstdio>

#include "engine/base/check.h"
#include "engine/io/frame_file.h"
#include "engine/io/statistics.h"
#include "render/image/golden_report.h"
#include "render/renderer.h"
#include "scenes/app/golden_file.h"
#include "scenes/app/run.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

render::Image draw(const GoldenOptions& options, const Golden& golden, std::string& renderer_name) {
  render::RenderOptions render_options;
  render_options.width = golden.width;
  render_options.height = golden.height;
  render_options.gl = options.gl;
  render::Renderer renderer(render_options);
  renderer_name = renderer.description();
  return renderer.draw(*read_frame(golden.frame_file()));
}

GoldenResult compare_with_baseline(const GoldenOptions& options, const std::string& name) {
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

std::vector<GoldenResult> compare_all(const GoldenOptions& options) {
  std::vector<GoldenResult> results;
  const auto names = options.names.empty() ? golden_names(options.folder) : options.names;
  for (const std::string& name : names) {
    results.push_back(compare_with_baseline(options, name));
    const GoldenResult& result = results.back();
    options.say((result.passed ? "pass " : "FAIL ") + name + ": " + result.verdict + "\n");
    if (!result.passed) {
      fs::create_directories(options.out);
      const fs::path picture = fs::path(options.out) / (name + ".png");
      render::write_png(picture, result.actual);
      options.say("     what was drawn: " + picture.string() + "\n");
    }
  }
  return results;
}

int failures(const std::vector<GoldenResult>& results) {
  int count = 0;
  for (const GoldenResult& result : results) count += result.passed ? 0 : 1;
  return count;
}

}  // namespace

int golden_test(const GoldenOptions& options) {
  const std::vector<GoldenResult> results = compare_all(options);
  options.write_json(format_results(results));
  return failures(results) == 0 ? 0 : 1;
}

int golden_report(const GoldenOptions& options) {
  const std::vector<GoldenResult> results = compare_all(options);
  fs::create_directories(options.out);
  const fs::path page = fs::path(options.out) / "report.html";
  std::vector<render::GoldenPicture> pictures;
  for (const GoldenResult& r : results) {
    pictures.push_back({r.golden.name, r.passed, r.verdict, r.baseline, r.actual, r.difference,
                        r.golden.thresholds, r.golden.command,
                        "sunder golden accept " + r.golden.name, r.renderer});
  }
  write_text(page.string(), render::golden_report(pictures));
  options.say("wrote " + page.string() + "\n");
  options.write_json(format_results(results));
  return failures(results) == 0 ? 0 : 1;
}

int golden_accept(const GoldenOptions& options) {
  for (const std::string& name : options.names) {
    Golden golden = read_golden(options.folder, name);
    const render::Image picture = draw(options, golden, golden.renderer);
    golden.cpu = cpu_name();
    golden.hash = pixel_hash(picture);
    render::write_png(golden.picture_file(), picture);
    write_golden(golden);
    options.say("accepted " + name + ", " + golden.hash + "\n");
  }
  return 0;
}

// Stores a frame of a scene as the subject of a golden; its picture still has to be accepted.
int golden_record(const GoldenOptions& options) {
  options.apply();
  const std::string& name = options.names.front();
  Scene scene = scenes::load_scene(options.scene, options.load);
  const int last = last_frame(scene, options.frame, "FRAME " + std::to_string(options.frame));
  Progress progress("record " + scene.name, last, options.quiet);
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
  options.say("recorded " + golden.frame_file().string() +
              "; look at it, then: sunder golden accept " + name + "\n");
  return 0;
}

}  // namespace sunder::app
