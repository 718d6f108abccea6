// sunder golden: regression tests of drawing, views and simulation. A golden is a stored frame and
// its picture, NAME.frame, NAME.png and NAME.json in tests/golden, and state hashes of the run that
// the frame is from, in hashes.txt. A golden of a large scene has NAME.view in place of NAME.frame,
// the frame without geometry, and its picture is drawn from the run. A test fails if the drawing of
// the frame, the camera and colours of its scene, or the states of the run change.
//
// NAME.original.png is the original picture of a golden that has crept away from it.
//
// Read first: golden_test(). Only `accept` changes the stored pictures and states.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <ranges>
#include <span>
#include <tuple>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "engine/io/bytes.h"
#include "engine/io/frame_file.h"
#include "engine/io/statistics.h"
#include "render/image/layer_picture.h"
#include "render/passes/layers.h"
#include "render/playback.h"
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

  /// Draws the picture of a golden. `before`: the picture before in a film, or null.
  render::Image draw(const Golden& golden, const Frame& frame, const Frame* before = nullptr) {
    render::Renderer& renderer = renderer_of(golden);
    render::Image image = renderer.draw(frame, before);
    if (golden.layer.empty()) return image;
    return render::layer_picture(renderer.layers().front(), image.width, image.height);
  }
  std::string description(const Golden& golden) { return renderer_of(golden).description(); }

 private:
  render::Renderer& renderer_of(const Golden& golden) {
    // The scale of depth is that of a renderer's first image: goldens of layers share none.
    const std::string alone = golden.layer.empty() ? "" : golden.name;
    auto& known = renderers_[{golden.width, golden.height, golden.view_mode, golden.hud,
                              golden.samples, golden.transparent, alone}];
    if (!known) {
      render::RenderOptions options;
      options.width = golden.width;
      options.height = golden.height;
      options.view_mode = golden.view_mode;
      options.hud = golden.hud;
      options.samples = golden.samples;
      options.transparent = golden.transparent;
      if (!golden.layer.empty()) options.layers = {golden.layer};
      options.gl = gl_;
      known = std::make_unique<render::Renderer>(options);
    }
    return *known;
  }

  std::string gl_;
  std::map<std::tuple<int, int, std::string, bool, int, bool, std::string>,
           std::unique_ptr<render::Renderer>>
      renderers_;
};

std::string size_of(const render::Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

/// Frames that a picture is drawn from.
struct Subject {
  FramePtr frame;
  FramePtr before;  ///< Picture before in a film; null if it is not needed.
};

/// Returns the stored frame of a golden, with the golden's changes of the view.
FramePtr stored_frame(const Golden& golden) {
  const FramePtr frame = read_frame(golden.frame_file());
  if (golden.is_simulated() || golden.load.set.empty()) return frame;
  auto seen = std::make_shared<Frame>(*frame);
  scenes::change_view(seen->view, golden.load.set, golden.file(".json").string());
  return seen;
}

std::string figures_of(const render::Difference& difference, const render::Thresholds& most) {
  char text[200];
  std::snprintf(text, sizeof text, "FLIP mean %.4f of %.4f, worst window %d of %d pixels",
                difference.flip_mean, most.flip_mean, difference.worst_window_pixels,
                most.window_pixels);
  return text;
}

/// Draws a golden and compares the picture with the baseline and the original. If `fault` is not
/// empty, it names another fault that changes the picture, and a different picture is not judged.
Verdict check_drawing(Drawer& drawer, GoldenResult& result, const Subject& subject,
                      const std::string& fault = "") {
  const Stopwatch watch;
  const Golden& golden = result.golden;
  Verdict verdict{golden.name, "drawing", Outcome::kFailed, {}};
  result.actual = drawer.draw(golden, *subject.frame, subject.before.get());
  result.renderer = drawer.description(golden);
  verdict.seconds = 1e-3 * watch.ms();
  result.original = read_original(golden);
  if (result.original.picture)
    result.from_original = render::compare(*result.original.picture, result.actual);
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
  if (passes && !result.original.fault.empty()) {
    verdict.text = "is not judged: " + result.original.fault;
    return verdict;
  }
  if (passes) verdict.outcome = Outcome::kPassed;
  if (!passes && !fault.empty()) {
    verdict.outcome = Outcome::kSkipped;
    verdict.text = "is not judged, because no frame is stored and the " + fault + " differs";
    return verdict;
  }
  verdict.text =
      result.difference.same_bytes
          ? "same"
          : (passes ? "similar: " : "differs: ") + figures_of(result.difference, golden.thresholds);
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

/// Simulates the scene of a golden and returns its frame and the one before, as `sunder render`
/// draws them.
Subject simulate(const Golden& golden, bool quiet) {
  Scene scene = scenes::load_scene(golden.scene_file(), golden.load);
  const int last =
      last_frame(scene, golden.last_source_frame(), "FRAME " + std::to_string(golden.frame));
  Progress progress("record " + scene.name, golden.frame, quiet);
  const render::ViewMode mode(golden.view_mode);
  const auto simulation = make_simulation(std::move(scene), {.inspect = mode.needs_inspection()});
  FramesUntil frames(*simulation, last);
  const auto wanted = static_cast<std::uint64_t>(golden.frame);
  render::ResampledSource pictures(frames, {.speed = golden.speed}, std::max(wanted, 1ul) - 1);
  Subject subject;
  while (!subject.frame || subject.frame->index < wanted) {
    subject.before = std::exchange(subject.frame, pictures.next());
    SUNDER_CHECK(subject.frame);
    progress.take(subject.frame);
  }
  progress.finish();
  return subject;
}

/// Compares the picture of a golden, its view and its simulation with the stored ones.
void compare(Drawer& drawer, GoldenResult& result, const GoldenOptions& options) {
  const Golden& golden = result.golden;
  Subject subject;
  std::string fault;
  if (golden.is_simulated()) {
    result.verdicts.push_back(check_view(golden));
    const std::string book = golden.hashes_file().string();
    scenes::FrameComparison run =
        scenes::compare_frames(golden.run(), scenes::read_hashes(book), book, options.full);
    if (!golden.has_frame) {
      subject =
          run.frame && !golden.is_film() ? Subject{run.frame, nullptr} : simulate(golden, true);
      if (!run.is_same) fault = "simulation";
      if (result.verdicts.front().outcome != Outcome::kPassed) fault = "view";
    }
    std::ranges::move(run.verdicts, std::back_inserter(result.verdicts));
  }
  if (!subject.frame) subject.frame = stored_frame(golden);
  result.verdicts.insert(result.verdicts.begin(), check_drawing(drawer, result, subject, fault));
}

std::string percent(double share) {
  return std::isfinite(share) ? std::to_string(std::lround(100 * share)) + " %" : "of another size";
}

/// Returns a line on the pictures that are farthest from their originals; empty if none differs.
std::string farthest_line(const std::vector<GoldenResult>& results) {
  constexpr std::size_t kListed = 5;
  std::string text;
  for (const GoldenResult* result : by_distance_from_original(results) | std::views::take(kListed))
    text += (text.empty() ? "" : ", ") + result->golden.name + " " +
            percent(result->share_of_original());
  return text.empty() ? "" : "farthest from the originals, of what is allowed: " + text + "\n";
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
  bool must_rebase = false;
  const auto names = options.names.empty() ? golden_names(options.folder) : options.names;
  for (const std::string& name : names) {
    GoldenResult& result = results.emplace_back();
    result.golden = read_golden(options.folder, name);
    compare(drawer, result, options);
    options.print((result.passed() ? "pass " : "FAIL ") + name + ": " + result.sentence() + "\n");
    if (!result.passed()) failed += (failed.empty() ? "" : " ") + name;
    if (!result.drawing_passed()) {
      must_rebase = must_rebase || result.must_rebase();
      fs::create_directories(options.out);
      const fs::path picture = fs::path(options.out) / (name + ".png");
      render::write_png(picture, result.actual);
      options.print("     what was drawn: " + picture.string() + "\n");
    }
  }
  options.print(farthest_line(results));
  if (!failed.empty()) {
    options.print(
        "To accept these results: " + accept_command(options.folder, failed, must_rebase) + "\n");
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

/// Returns why a picture is not accepted without --rebase.
std::string reason_to_refuse(const GoldenResult& result) {
  if (!result.original.fault.empty()) return result.original.fault;
  const Golden& golden = result.golden;
  const std::string how_far = result.from_original.same_size
                                  ? figures_of(result.from_original, golden.thresholds)
                                  : size_of(result.actual) + " in place of " +
                                        size_of(*result.original.picture) + " pixels";
  return "the picture is too far from the original: " + how_far +
         "; look at it by `sunder golden report`, then run: " + golden.accept_command(true);
}

/// Stores the picture that was drawn as the baseline, if it is another one. The first time that
/// pictures differ, the original is stored apart. Returns what was done.
std::string store_picture(GoldenResult& result, bool is_similar, const std::string& reason) {
  Golden& golden = result.golden;
  const std::optional<render::Image>& original = result.original.picture;
  const bool is_original = original && *original == result.actual;
  const bool rebases = !reason.empty() && !is_original;
  const bool is_new = golden.hash.empty();
  if (!is_new && !rebases && result.difference.same_bytes) return "drawing unchanged";
  // Pixels depend on the driver and on the processor: a similar picture of others is no news.
  const bool is_of_this_machine = golden.renderer == result.renderer && golden.cpu == cpu_name();
  if (!is_new && !rebases && is_similar && !is_of_this_machine)
    return "drawing similar; the stored one is kept, which is of another driver or processor";
  const bool creeps = original && !is_original && !rebases;
  if (creeps && !fs::exists(golden.original_file()))
    render::write_png(golden.original_file(), *original);
  golden.original = creeps ? pixel_hash(*original) : "";
  if (rebases) golden.rebased = reason;
  golden.renderer = result.renderer;
  golden.cpu = cpu_name();
  golden.hash = pixel_hash(result.actual);
  render::write_png(golden.picture_file(), result.actual);
  write_golden(golden);
  if (!creeps) fs::remove(golden.original_file());
  std::string message = "drawing " + golden.hash;
  if (original && result.from_original.same_size && !is_original) {
    message += rebases ? ", the new original, from the last one " : ", from the original ";
    message += figures_of(result.from_original, golden.thresholds);
  }
  return message;
}

/// Throws InputError for options of the picture that do not go together.
void check_picture(const Golden& golden, const GoldenOptions& options) {
  const std::string what = "golden record " + golden.name + " " + options.scene + ": ";
  if (!golden.layer.empty()) {
    render::check_layers(std::vector<std::string>{golden.layer});
    if (golden.hud || golden.transparent)
      throw InputError(what + "--hud and --transparent do not apply to a layer; remove them");
  }
  if (golden.speed != 1 && golden.has_frame)
    throw InputError(what + "--speed draws between the frames of a scene; add --no-frame");
  if (golden.to_the_end && !golden.is_simulated())
    throw InputError(what + "--to-the-end does not apply to a stored frame; give a scene");
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
                        r.golden.thresholds, r.golden.command(),
                        r.golden.accept_command(r.must_rebase()), r.renderer});
    if (!r.golden.original.empty() && r.original.picture)
      pictures.back().original = *r.original.picture;
    pictures.back().from_original = r.from_original;
    pictures.back().rebased = r.golden.rebased;
    for (const Verdict& verdict : std::span(r.verdicts).subspan(1)) {
      pictures.back().runs.push_back(
          {{verdict.what}, {verdict.text, verdict.outcome == Outcome::kFailed}});
    }
  }
  write_file(page, scenes::golden_report(pictures));
  options.print("wrote " + page.string() + "\n");
  return exit_code(results);
}

/// Stores new pictures, frames and states where they differ, and leaves the others unchanged. A
/// golden whose picture is too far from the original is left as it is, without --rebase.
int golden_accept(const GoldenOptions& options) {
  options.apply();
  print_folder(options);
  Drawer drawer(options.gl);
  bool refused = false;
  for (const std::string& name : options.names) {
    GoldenResult result;
    result.golden = read_golden(options.folder, name);
    Golden& golden = result.golden;
    const bool has_other_view =
        golden.is_simulated() && check_view(golden).outcome != Outcome::kPassed;
    Subject subject;
    if (has_other_view || !golden.has_frame) subject = simulate(golden, options.quiet);
    const FramePtr new_frame = subject.frame;
    if (golden.has_frame) subject = {new_frame ? as_stored(*new_frame) : stored_frame(golden), {}};
    const bool is_similar = check_drawing(drawer, result, subject).outcome == Outcome::kPassed;
    if (options.rebase.empty() && result.must_rebase()) {
      options.print("refused " + name + ": " + reason_to_refuse(result) + "\n");
      refused = true;
      continue;
    }
    if (has_other_view) store_frame(golden, *new_frame);
    std::string message = store_picture(result, is_similar, options.rebase);
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
  return refused ? 1 : 0;
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
  golden.samples = options.render.samples;
  golden.transparent = options.render.transparent;
  golden.layer = options.layer;
  golden.speed = options.speed;
  golden.to_the_end = options.to_the_end;
  render::RenderOptions size;
  parse_size(options.size, size);
  golden.width = size.width;
  golden.height = size.height;
  if (fs::is_regular_file(options.scene)) {
    golden.scene =
        fs::proximate(fs::absolute(options.scene), fs::absolute(options.folder)).string();
  }
  golden.has_frame = !options.no_frame;
  if (options.no_frame &&
      (!golden.is_simulated() || render::ViewMode(golden.view_mode).needs_inspection())) {
    throw InputError("golden record " + golden.name + " " + options.scene +
                     ": --no-frame does not apply to a stored frame or to --view-mode " +
                     golden.view_mode);
  }
  check_picture(golden, options);
  fs::create_directories(options.folder);
  if (golden.is_simulated()) {
    if (options.frame < 0)
      throw InputError("golden record " + golden.name + " " + options.scene +
                       ": FRAME is missing; give the index of a frame of the scene");
    golden.frame = options.frame;
    const FramePtr frame = simulate(golden, options.quiet).frame;
    if (golden.has_frame && golden.samples > 1 && frame->view.shutter > 0)
      throw InputError("golden record " + golden.name + " " + options.scene +
                       ": a stored frame has no motion to blur; add --no-frame or set "
                       "view.shutter=0");
    store_frame(golden, *frame);
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
