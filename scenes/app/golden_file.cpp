#include "scenes/app/golden_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <set>
#include <span>
#include <string_view>

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/io/bytes.h"
#include "engine/io/figures.h"
#include "engine/model/view_path.h"
#include "scenes/app/commands.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/file/text_file.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSide_px = 8192;                      // as --size
constexpr int kMaxSamples = 1024;                      // as --samples
constexpr double kMinSpeed = 0.001, kMaxSpeed = 1000;  // as --speed

template <class T>
T value(const Figures& figures, const std::string& place, const fs::path& file) {
  const auto found = figures.find(place);
  const T* exact = found == figures.end() ? nullptr : std::get_if<T>(&found->second);
  if (!exact) throw InputError(file.string() + ": " + place + " is missing or of the wrong type");
  return *exact;
}

/// As value(), for a key that is left out if it has the usual value.
template <class T>
T value_or(const Figures& figures, const std::string& place, const fs::path& file, T usual) {
  return figures.contains(place) ? value<T>(figures, place, file) : usual;
}

int whole(const Figures& figures, const std::string& place, const fs::path& file, int low,
          int high) {
  const auto number = value<std::int64_t>(figures, place, file);
  if (number < low || number > high) {
    throw InputError(file.string() + ": " + place + " is " + std::to_string(number) +
                     "; allowed: a whole number from " + std::to_string(low) + " to " +
                     std::to_string(high));
  }
  return static_cast<int>(number);
}

/// Returns a word quoted for a shell, if necessary.
std::string quoted(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./=,:").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

/// Returns a number with the fewest digits that give it again.
std::string short_number(double number) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, number);
  return {text, end};
}

bool same_look(const Look& a, const Look& b) {
  return a.texture == b.texture && a.color == b.color;
}

/// Returns the keys of [view] whose values differ.
std::vector<std::string> different_keys(const View& a, const View& b) {
  std::vector<std::string> keys;
  const auto compare = [&](const char* key, const auto& x, const auto& y) {
    if (x != y) keys.push_back(std::string("view.") + key);
  };
  compare("eye", a.eye_W, b.eye_W);
  compare("target", a.target_W, b.target_W);
  compare("fov_deg", a.fov_rad, b.fov_rad);
  compare("sun", a.to_sun_W, b.to_sun_W);
  compare("ground_color", a.ground_color, b.ground_color);
  compare("exposure", a.exposure, b.exposure);
  compare("shutter", a.shutter, b.shutter);
  compare("sun_color", a.sun_color, b.sun_color);
  compare("sky_color", a.sky_color, b.sky_color);
  compare("sun_strength", a.sun_strength, b.sun_strength);
  compare("sky_strength", a.sky_strength, b.sky_strength);
  return keys;
}

}  // namespace

std::vector<std::string> golden_names(const fs::path& folder) {
  std::vector<std::string> names;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
  }
  if (names.empty())
    throw InputError(fs::absolute(folder).lexically_normal().string() +
                     ": no goldens (NAME.json) in this folder; give their folder by --folder");
  std::sort(names.begin(), names.end());
  return names;
}

std::string Golden::scene_file() const {
  const fs::path here = folder / scene;
  return fs::is_regular_file(here) ? here.lexically_normal().string() : scene;
}

fs::path Golden::frame_file() const {
  return is_simulated() ? file(has_frame ? ".frame" : ".view") : fs::path(scene_file());
}

int Golden::last_source_frame() const {
  if (speed == 1) return frame;
  // Interpolation between two frames depends on the next one, too.
  return static_cast<int>(std::ceil(frame * speed)) + 1;
}

std::string accept_command(const fs::path& folder, const std::string& names, bool rebases) {
  const std::string given = names + (rebases ? " --rebase \"REASON\"" : "");
  if (folder == installed_goldens_folder()) {
    return "mkdir -p tests && cp -r " + quoted(folder.string()) +
           " tests/golden && sunder golden accept " + given;
  }
  const bool is_usual = folder == own_goldens_folder();
  return "sunder golden accept " + given + (is_usual ? "" : " --folder " + quoted(folder.string()));
}

std::string Golden::accept_command(bool rebases) const {
  return app::accept_command(folder, name, rebases);
}

std::string Golden::command() const {
  std::string text = "sunder golden record " + name + " " + quoted(scene_file());
  if (is_simulated()) text += " " + std::to_string(frame) + " --preset " + load.preset;
  for (const std::string& assignment : load.set) text += " --set " + quoted(assignment);
  text += " --size " + std::to_string(width) + "x" + std::to_string(height);
  if (view_mode != Golden().view_mode) text += " --view-mode " + view_mode;
  if (hud) text += " --hud";
  if (samples != 1) text += " --samples " + std::to_string(samples);
  if (transparent) text += " --transparent";
  if (!layer.empty()) text += " --layer " + layer;
  if (speed != 1) text += " --speed " + short_number(speed);
  if (!has_frame) text += " --no-frame";
  if (to_the_end) text += " --to-the-end";
  if (folder != own_goldens_folder()) text += " --folder " + quoted(folder.string());
  return text + " && " + accept_command();
}

Golden read_golden(const fs::path& folder, const std::string& name) {
  Golden golden;
  golden.folder = folder;
  golden.name = name;
  const fs::path file = golden.file(".json");
  if (!fs::exists(file)) {
    std::string known;
    for (const std::string& other : golden_names(folder)) known += " " + other;
    throw InputError(name + ": no such golden; goldens:" + known);
  }
  const Figures figures =
      parse_figures(scenes::read_text(file, file_kinds::kFigures), file.string());
  golden.scene = value<std::string>(figures, "/scene", file);
  golden.load.preset = value<std::string>(figures, "/preset", file);
  for (int i = 0; figures.contains("/set/" + std::to_string(i)); ++i) {
    golden.load.set.push_back(value<std::string>(figures, "/set/" + std::to_string(i), file));
  }
  golden.frame = whole(figures, "/frame", file, 0, std::numeric_limits<int>::max());
  golden.width = whole(figures, "/width", file, 1, kMaxSide_px);
  golden.height = whole(figures, "/height", file, 1, kMaxSide_px);
  golden.view_mode = value<std::string>(figures, "/view_mode", file);
  golden.hud = value<bool>(figures, "/hud", file);
  golden.has_frame = !fs::exists(golden.file(".view"));
  golden.thresholds.flip_mean = value<double>(figures, "/thresholds/flip_mean", file);
  golden.thresholds.window_pixels =
      whole(figures, "/thresholds/window_pixels", file, 0, std::numeric_limits<int>::max());
  golden.hash = value<std::string>(figures, "/hash", file);
  golden.renderer = value<std::string>(figures, "/renderer", file);
  golden.cpu = value<std::string>(figures, "/cpu", file);
  golden.samples =
      figures.contains("/samples") ? whole(figures, "/samples", file, 1, kMaxSamples) : 1;
  golden.transparent = value_or(figures, "/transparent", file, false);
  golden.layer = value_or<std::string>(figures, "/layer", file, "");
  golden.speed = figures.contains("/speed") ? number_at(figures, "/speed") : 1;
  if (!(golden.speed >= kMinSpeed && golden.speed <= kMaxSpeed))
    throw InputError(file.string() + ": /speed is not a number from 0.001 to 1000");
  golden.to_the_end = value_or(figures, "/to_the_end", file, false);
  golden.original = value_or<std::string>(figures, "/original", file, "");
  golden.rebased = value_or<std::string>(figures, "/rebased", file, "");
  return golden;
}

void write_golden(const Golden& golden) {
  Figures figures = {{"/scene", golden.scene},
                     {"/preset", golden.load.preset},
                     {"/frame", std::int64_t{golden.frame}},
                     {"/width", std::int64_t{golden.width}},
                     {"/height", std::int64_t{golden.height}},
                     {"/view_mode", golden.view_mode},
                     {"/hud", golden.hud},
                     {"/thresholds/flip_mean", golden.thresholds.flip_mean},
                     {"/thresholds/window_pixels", std::int64_t{golden.thresholds.window_pixels}},
                     {"/hash", golden.hash},
                     {"/renderer", golden.renderer},
                     {"/cpu", golden.cpu}};
  for (std::size_t i = 0; i < golden.load.set.size(); ++i) {
    figures["/set/" + std::to_string(i)] = golden.load.set[i];
  }
  // Keys of usual values are left out.
  if (golden.samples != 1) figures["/samples"] = std::int64_t{golden.samples};
  if (golden.transparent) figures["/transparent"] = true;
  if (!golden.layer.empty()) figures["/layer"] = golden.layer;
  if (golden.speed != 1) figures["/speed"] = golden.speed;
  if (golden.to_the_end) figures["/to_the_end"] = true;
  if (!golden.original.empty()) figures["/original"] = golden.original;
  if (!golden.rebased.empty()) figures["/rebased"] = golden.rebased;
  write_file(golden.file(".json"), format_figures(figures));
}

Original read_original(const Golden& golden) {
  const bool is_apart = fs::exists(golden.original_file());
  const fs::path file = is_apart ? golden.original_file() : golden.picture_file();
  // A golden that was recorded anew has no hashes until it is accepted.
  const bool is_known = !golden.hash.empty();
  const std::string hash = !golden.original.empty() ? golden.original : golden.hash;
  const std::string remedy =
      "; restore it from version control, or look at the new picture and "
      "accept it by --rebase";
  if (is_known && !golden.original.empty() && !is_apart)
    return {{}, "the original picture " + golden.original_file().string() + " is missing" + remedy};
  if (!fs::exists(file)) {
    if (!is_known) return {};
    return {{}, "the accepted picture " + file.string() + " is missing" + remedy};
  }
  Original original{render::read_png(file), {}};
  if (is_known && pixel_hash(*original.picture) != hash)
    return {{}, file.string() + " is not the picture that was accepted" + remedy};
  return original;
}

bool GoldenResult::drawing_passed() const {
  return verdicts.front().outcome == scenes::Outcome::kPassed;
}

bool GoldenResult::passed() const {
  return std::ranges::all_of(verdicts, [](const scenes::Verdict& verdict) {
    return verdict.outcome == scenes::Outcome::kPassed;
  });
}

std::string GoldenResult::sentence() const {
  std::string text = "drawing " + verdicts.front().text;
  bool is_same = true;
  for (const scenes::Verdict& verdict : std::span(verdicts).subspan(1)) {
    if (verdict.outcome == scenes::Outcome::kPassed) continue;
    text += "; " + verdict.what + " " + verdict.text;
    is_same = false;
  }
  return text + (is_same && golden.is_simulated() ? "; simulation same" : "");
}

std::vector<const GoldenResult*> by_distance_from_original(
    const std::vector<GoldenResult>& results) {
  std::vector<const GoldenResult*> order;
  for (const GoldenResult& result : results) {
    if (result.share_of_original() > 0) order.push_back(&result);
  }
  std::ranges::stable_sort(order, std::greater(), &GoldenResult::share_of_original);
  return order;
}

std::string format_results(const std::vector<GoldenResult>& results) {
  Figures figures;
  const auto farthest = by_distance_from_original(results);
  if (farthest.empty()) figures["/farthest_from_original"] = EmptyList();
  for (std::size_t i = 0; i < farthest.size(); ++i) {
    figures["/farthest_from_original/" + std::to_string(i)] = farthest[i]->golden.name;
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    const GoldenResult& result = results[i];
    const std::string at = "/goldens/" + std::to_string(i);
    figures[at + "/name"] = result.golden.name;
    figures[at + "/passed"] = result.passed();
    figures[at + "/verdict"] = result.sentence();
    figures[at + "/same_bytes"] = result.difference.same_bytes;
    figures[at + "/flip_mean"] = result.difference.flip_mean;
    figures[at + "/worst_window_pixels"] = std::int64_t{result.difference.worst_window_pixels};
    figures[at + "/original/flip_mean"] = result.from_original.flip_mean;
    figures[at + "/original/worst_window_pixels"] =
        std::int64_t{result.from_original.worst_window_pixels};
    figures[at + "/original/rebased"] = result.golden.rebased;
    figures[at + "/renderer"] = result.renderer;
    figures[at + "/remade_by"] = result.golden.command();
    for (std::size_t j = 0; j < result.verdicts.size(); ++j) {
      const scenes::Verdict& verdict = result.verdicts[j];
      const std::string of = at + "/verdicts/" + std::to_string(j);
      figures[of + "/what"] = verdict.what;
      figures[of + "/passed"] = verdict.outcome == scenes::Outcome::kPassed;
      figures[of + "/text"] = verdict.text;
    }
  }
  return format_figures(figures);
}

std::string view_differences(const Frame& stored, const Scene& scene) {
  std::vector<std::string> names =
      different_keys(stored.view, along(scene.view_keys, scene.view, stored.time_s));
  const auto find = [&](const std::string& name) {
    return std::ranges::find(scene.materials, name, &Material::name);
  };
  std::set<std::string> seen;  // materials in the frame
  for (const Instance& instance : stored.instances) {
    const MaterialIndex material = (*stored.meshes)[instance.mesh.value]->material;
    const std::string& name = (*stored.materials)[material.value].name;
    seen.insert(name);
    // The key of a body that is a whole solid, or the remaining part of one, is the solid's index.
    const std::uint64_t key = stored.bodies[instance.body].key;
    if (key >= scene.solids.size()) continue;
    const Solid& solid = scene.solids[key];
    const auto is_of_it = [&](const ConvexPtr& convex) {
      return scene.materials[convex->material.value].name == name;
    };
    if (std::ranges::none_of(solid.compound.convexes, is_of_it))
      names.push_back("material of " + solid.name);
  }
  for (const Material& material : *stored.materials) {
    if (!seen.contains(material.name)) continue;
    const auto now = find(material.name);
    if (now == scene.materials.end() || !same_look(material.surface, now->surface) ||
        !same_look(material.interior, now->interior))
      names.push_back("colours of " + material.name);
  }
  const std::vector<Appearance> none;
  if (!std::ranges::equal(stored.appearances ? *stored.appearances : none, scene.appearances,
                          scenes::same_appearance))
    names.emplace_back("paints");
  std::string text;
  std::set<std::string> listed;
  for (const std::string& name : names) {
    if (listed.insert(name).second) text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

std::string pixel_hash(const render::Image& image) {
  std::uint64_t hash =
      combine(static_cast<std::uint64_t>(image.width), static_cast<std::uint64_t>(image.height));
  for (const std::uint8_t byte : image.rgb) hash = combine(hash, byte);
  for (const std::uint8_t byte : image.alpha) hash = combine(hash, byte);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Frame without_geometry(const Frame& frame) {
  Frame smaller;
  smaller.time_s = frame.time_s;
  smaller.view = frame.view;
  smaller.materials = frame.materials;
  smaller.appearances = frame.appearances;
  for (const FrameBody& body : frame.bodies) smaller.bodies.emplace_back().key = body.key;
  MeshStore meshes;  // an empty one for each material
  for (std::size_t i = 0; i < frame.materials->size(); ++i) {
    Mesh empty;
    empty.material = MaterialIndex(i);
    meshes.push_back(std::make_shared<const Mesh>(std::move(empty)));
  }
  smaller.meshes = std::make_shared<const MeshStore>(std::move(meshes));
  for (const Instance& instance : frame.instances) {
    const MaterialIndex material = (*frame.meshes)[instance.mesh.value]->material;
    smaller.instances.push_back({MeshIndex(material.value), instance.body});
  }
  return smaller;
}

}  // namespace sunder::app
