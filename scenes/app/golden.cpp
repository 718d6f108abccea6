// sunder golden: regression tests of drawing, views and simulation. A golden is a stored frame and
// its picture, NAME.frame, NAME.png and NAME.json in tests/golden, and state hashes of the run that
// the frame is from, in hashes.txt. A golden of a large scene has NAME.view in place of NAME.frame,
// the frame without geometry, and its picture is drawn from the run. A test fails if the drawing of
// the frame, the camera and colours of its scene, or the states of the run change.
//
// Read first: golden_test(). Only `accept` changes the stored pictures and states.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <memory>
#include <tuple>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "engine/io/bytes.h"
#include "engine/io/frame_file.h"
#include "engine/io/statistics.h"
#include "render/renderer.h"
#include "render/view_mode.h"
#include "scenes/app/arguments.h"
#include "scenes/app/golden_file.h"
#include "scenes/app/run.h"
#include "scenes/file/view.h"
#include "scenes/report/golden_report.h"
#include "scenes/timing/frame_states.h"
#include "scenes/timing/hash_book.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;
using scenes::Outcome;
using scenes::Verdict;

/// Draws goldens; those with equal settings share a renderer.
class Drawer {
 public:
  explicit Drawer(std::string gl) : gl_(std::move(gl)) {}

  render::Image draw(const Golden& golden, const Frame& frame) {
    return renderer(golden).draw(frame);
  }
  std::string description(const Golden& golden) { return renderer(golden).description(); }

 private:
  render::Renderer& renderer(const Golden& golden) {
    auto& known = renderers_[{golden.width, golden.height, golden.view_mode, golden.hud}];
    if (!known) {
      render::RenderOptions options;
      options.width = golden.width;
      options.height = golden.height;
      options.view_mode = golden.view_mode;
      options.hud = golden.hud;
      options.gl = gl_;
      known = std::make_unique<render::Renderer>(options);
    }
    return *known;
  }

  std::string gl_;
  std::map<std::tuple<int, int, std::string, bool>, std::unique_ptr<render::Renderer>> renderers_;
};

std::string size_of(const render::Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

/// Returns the stored frame of a golden, with the golden's changes of the view.
FramePtr stored_frame(const Golden& golden) {
  const FramePtr frame = read_frame(golden.frame_file());
  if (golden.is_simulated() || golden.load.set.empty()) return frame;
  auto seen = std::make_shared<Frame>(*frame);
  scenes::change_view(seen->view, golden.load.set, golden.file(".json").string());
  return seen;
}

/// Draws a frame of a golden and compares the picture with the baseline. If `fault` is not empty,
/// it names another fault that changes the picture, and a different picture is not judged.
Verdict check_drawing(Drawer& drawer, GoldenResult& result, const Frame& frame,
                      const std::string& fault = "") {
  const Stopwatch watch;
  const Golden& golden = result.golden;
  Verdict verdict{golden.name, "drawing", Outcome::kFailed, {}};
  result.actual = drawer.draw(golden, frame);
  result.renderer = drawer.description(golden);
  verdict.seconds = 1e-3 * watch.ms();
  if (!fs::exists(golden.picture_file())) {
    verdict.text = "has no baseline; check the picture, then run: " + golden.accept_command();
    return verdict;
  }
  result.baseline = render::read_png(golden.picture_file());
  if (result.baseline.width != result.actual.width ||
      result.baseline.height != result.actual.height) {
    verdict.text = "the baseline " + golden.picture_file().string() +
                   " has another size: " + size_of(result.baseline) + ", the picture " +
                   size_of(result.actual);
    return verdict;
  }
  result.difference = render::compare(result.baseline, result.actual);
  const bool passes = result.difference.passes(golden.thresholds);
  if (passes) verdict.outcome = Outcome::kPassed;
  if (!passes && !fault.empty()) {
    verdict.outcome = Outcome::kSkipped;
    verdict.text = "is not judged, because no frame is stored and the " + fault + " differs";
    return verdict;
  }
  char text[200];
  std::snprintf(text, sizeof text, "%s: FLIP mean %.4f of %.4f, worst window %d of %d pixels",
                passes ? "similar" : "differs", result.difference.flip_mean,
                golden.thresholds.flip_mean, result.difference.worst_window_pixels,
                golden.thresholds.window_pixels);
  verdict.text = result.difference.same_bytes ? "same" : text;
  return verdict;
}

/// Checks that the stored frame still has the camera and colours of its scene.
Verdict check_view(const Golden& golden) {
  const Stopwatch watch;
  const std::string other = view_differences(*read_frame(golden.frame_file()),
                                             scenes::load_scene(golden.scene_file(), golden.load));
  Verdict verdict{golden.name, "view", Outcome::kPassed, "equal to the stored frame"};
  if (!other.empty()) {
    verdict.outcome = Outcome::kFailed;
    verdict.text = "of the scene differs from the stored frame: " + other;
  }
  verdict.seconds = 1e-3 * watch.ms();
  return verdict;
}

/// Simulates the scene of a golden and returns its frame.
FramePtr simulated_frame(const Golden& golden, bool quiet) {
  Scene scene = scenes::load_scene(golden.scene_file(), golden.load);
  const int last = last_frame(scene, golden.frame, "FRAME " + std::to_string(golden.frame));
  Progress progress("record " + scene.name, last, quiet);
  const render::ViewMode mode(golden.view_mode);
  const auto simulation = make_simulation(std::move(scene), {.inspect = mode.needs_inspection()});
  FramePtr frame;
  for (int i = 0; i <= last; ++i) {
    frame = simulation->next();
    progress.take(frame);
  }
  progress.finish();
  return frame;
}

/// Compares the picture of a golden, its view and its simulation with the stored ones.
void compare(Drawer& drawer, GoldenResult& result, const GoldenOptions& options) {
  const Golden& golden = result.golden;
  FramePtr frame;
  std::string fault;
  if (golden.is_simulated()) {
    result.verdicts.push_back(check_view(golden));
    const std::string book = golden.hashes_file().string();
    scenes::FrameComparison run =
        scenes::compare_frames(golden.run(), scenes::read_hashes(book), book, options.full);
    if (!golden.has_frame) {
      frame = run.frame ? run.frame : simulated_frame(golden, options.quiet);
      if (!run.is_same) fault = "simulation";
      if (result.verdicts.front().outcome != Outcome::kPassed) fault = "view";
    }
    std::ranges::move(run.verdicts, std::back_inserter(result.verdicts));
  }
  if (!frame) frame = stored_frame(golden);
  result.verdicts.insert(result.verdicts.begin(), check_drawing(drawer, result, *frame, fault));
}

void print_folder(const GoldenOptions& options) {
  options.print("goldens of " + place_text(options.folder) + "\n");
}

std::vector<GoldenResult> compare_all(const GoldenOptions& options) {
  options.apply();
  print_folder(options);
  Drawer drawer(options.gl);
  std::vector<GoldenResult> results;
  std::string failed;
  const auto names = options.names.empty() ? golden_names(options.folder) : options.names;
  for (const std::string& name : names) {
    GoldenResult& result = results.emplace_back();
    result.golden = read_golden(options.folder, name);
    compare(drawer, result, options);
    options.print((result.passed() ? "pass " : "FAIL ") + name + ": " + result.sentence() + "\n");
    if (!result.passed()) failed += (failed.empty() ? "" : " ") + name;
    if (!result.drawing_passed()) {
      fs::create_directories(options.out);
      const fs::path picture = fs::path(options.out) / (name + ".png");
      render::write_png(picture, result.actual);
      options.print("     what was drawn: " + picture.string() + "\n");
    }
  }
  if (!failed.empty()) {
    options.print("To accept these results: " + accept_command(options.folder, failed) + "\n");
  }
  if (!options.junit.empty()) {
    std::vector<Verdict> verdicts;
    for (const GoldenResult& result : results) {
      verdicts.insert(verdicts.end(), result.verdicts.begin(), result.verdicts.end());
    }
    write_file(options.junit, scenes::junit_xml("golden", verdicts));
  }
  options.write_json(format_results(results));
  return results;
}

int exit_code(const std::vector<GoldenResult>& results) {
  return std::ranges::all_of(results, &GoldenResult::passed) ? 0 : 1;
}

/// Throws InputError for a name with other characters than letters, digits, _ and -. Names are
/// parts of file names, and of keys in hashes.txt.
void check_name(const std::string& name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!name.empty() && std::ranges::all_of(name, fits)) return;
  throw InputError("golden record \"" + name + "\": a name may have only letters, digits, _ and -");
}

/// Stores the frame of a golden, or what is stored in its place.
void store_frame(const Golden& golden, const Frame& frame) {
  write_frame(golden.frame_file(), golden.has_frame ? frame : without_geometry(frame));
  fs::remove(golden.file(golden.has_frame ? ".view" : ".frame"));
}

}  // namespace

int golden_test(const GoldenOptions& options) { return exit_code(compare_all(options)); }

int golden_report(const GoldenOptions& options) {
  const std::vector<GoldenResult> results = compare_all(options);
  fs::create_directories(options.out);
  const fs::path page = fs::path(options.out) / "report.html";
  std::vector<scenes::GoldenResult> pictures;
  for (const GoldenResult& r : results) {
    pictures.push_back({r.golden.name, r.passed(), r.sentence(), r.baseline, r.actual, r.difference,
                        r.golden.thresholds, r.golden.command(), r.golden.accept_command(),
                        r.renderer});
    for (const Verdict& verdict : std::span(r.verdicts).subspan(1)) {
      pictures.back().runs.push_back(
          {{verdict.what}, {verdict.text, verdict.outcome == Outcome::kFailed}});
    }
  }
  write_file(page, scenes::golden_report(pictures));
  options.print("wrote " + page.string() + "\n");
  return exit_code(results);
}

/// Stores new pictures, frames and states where they differ, and leaves the others unchanged.
int golden_accept(const GoldenOptions& options) {
  options.apply();
  print_folder(options);
  Drawer drawer(options.gl);
  for (const std::string& name : options.names) {
    GoldenResult result;
    result.golden = read_golden(options.folder, name);
    Golden& golden = result.golden;
    std::string message = "drawing unchanged";
    const bool has_other_view =
        golden.is_simulated() && check_view(golden).outcome != Outcome::kPassed;
    FramePtr frame;
    if (has_other_view || !golden.has_frame) frame = simulated_frame(golden, options.quiet);
    if (has_other_view) store_frame(golden, *frame);
    if (golden.has_frame) frame = stored_frame(golden);
    if (check_drawing(drawer, result, *frame).outcome != Outcome::kPassed || golden.hash.empty()) {
      golden.renderer = result.renderer;
      golden.cpu = cpu_name();
      golden.hash = pixel_hash(result.actual);
      render::write_png(golden.picture_file(), result.actual);
      write_golden(golden);
      message = "drawing " + golden.hash;
    }
    if (has_other_view) message += golden.has_frame ? ", new frame" : ", new view";
    if (golden.is_simulated()) {
      const std::string file = golden.hashes_file().string();
      const scenes::StateHashes before = scenes::read_hashes(file);
      scenes::StateHashes book = before;
      scenes::accept_frames(golden.run(), book);
      if (book != before) write_file(file, scenes::format_hashes(book));
      message += book == before ? ", simulation unchanged" : ", new simulation";
    }
    options.print("accepted " + name + ": " + message + "\n");
  }
  return 0;
}

// Stores a frame of a scene as a golden, whose picture and states must still be accepted.
int golden_record(const GoldenOptions& options) {
  options.apply();
  print_folder(options);
  check_name(options.names.front());
  Golden golden;
  golden.folder = options.folder;
  golden.name = options.names.front();
  golden.scene = options.scene;
  golden.load = options.load;
  golden.view_mode = options.render.view_mode;
  golden.hud = options.render.hud;
  render::RenderOptions size;
  parse_size(options.size, size);
  golden.width = size.width;
  golden.height = size.height;
  if (fs::is_regular_file(options.scene)) {
    golden.scene =
        fs::proximate(fs::absolute(options.scene), fs::absolute(options.folder)).string();
  }
  if (options.no_frame &&
      (!golden.is_simulated() || render::ViewMode(golden.view_mode).needs_inspection())) {
    throw InputError("golden record " + golden.name + " " + options.scene +
                     ": --no-frame does not apply to a stored frame or to --view-mode " +
                     golden.view_mode);
  }
  fs::create_directories(options.folder);
  if (golden.is_simulated()) {
    if (options.frame < 0)
      throw InputError("golden record " + golden.name + " " + options.scene +
                       ": FRAME is missing; give the index of a frame of the scene");
    golden.frame = options.frame;
    golden.has_frame = !options.no_frame;
    store_frame(golden, *simulated_frame(golden, options.quiet));
  } else {
    if (options.frame >= 0)
      throw InputError("golden record " + golden.name + " " + options.scene +
                       ": a stored frame has no other frames; remove FRAME");
    Drawer(options.gl).draw(golden, *stored_frame(golden));  // throws if the frame cannot be drawn
  }
  write_golden(golden);
  options.print("recorded " + golden.file(".json").string() +
                "; check it, then run: " + golden.accept_command() + "\n");
  return 0;
}

}  // namespace sunder::app
