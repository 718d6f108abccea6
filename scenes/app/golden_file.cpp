#include "scenes/app/golden_file.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/io/figures.h"
#include "scenes/app/commands.h"
#include "scenes/file/text_file.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPixels = 8192;  // of a side, as --size

template <class T>
T value(const Figures& figures, const std::string& place, const fs::path& file) {
  const auto found = figures.find(place);
  const T* exact = found == figures.end() ? nullptr : std::get_if<T>(&found->second);
  if (!exact) throw InputError(file.string() + ": " + place + " is missing or of the wrong type");
  return *exact;
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

}  // namespace

std::vector<std::string> golden_names(const fs::path& folder) {
  std::vector<std::string> names;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
  }
  if (names.empty()) throw InputError(folder.string() + ": no goldens (NAME.json) here");
  std::sort(names.begin(), names.end());
  return names;
}

Golden read_golden(const fs::path& folder, const std::string& name) {
  Golden golden;
  golden.folder = folder;
  golden.name = name;
  const fs::path file = golden.file(".json");
  if (!fs::exists(file)) {
    std::string known;
    for (const std::string& other : golden_names(folder)) known += " " + other;
    throw InputError(name + ": no such golden; there are:" + known);
  }
  const Figures figures = parse_figures(scenes::read_text(file), file.string());
  golden.width = whole(figures, "/width", file, 1, kMostPixels);
  golden.height = whole(figures, "/height", file, 1, kMostPixels);
  golden.thresholds.flip_mean = value<double>(figures, "/thresholds/flip_mean", file);
  golden.thresholds.window_pixels =
      whole(figures, "/thresholds/window_pixels", file, 0, std::numeric_limits<int>::max());
  golden.command = value<std::string>(figures, "/command", file);
  golden.hash = value<std::string>(figures, "/hash", file);
  golden.renderer = value<std::string>(figures, "/renderer", file);
  golden.cpu = value<std::string>(figures, "/cpu", file);
  return golden;
}

void write_golden(const Golden& golden) {
  write_text(
      golden.file(".json").string(),
      format_figures({{"/width", std::int64_t{golden.width}},
                      {"/height", std::int64_t{golden.height}},
                      {"/thresholds/flip_mean", golden.thresholds.flip_mean},
                      {"/thresholds/window_pixels", std::int64_t{golden.thresholds.window_pixels}},
                      {"/command", golden.command},
                      {"/hash", golden.hash},
                      {"/renderer", golden.renderer},
                      {"/cpu", golden.cpu}}));
}

std::string format_results(const std::vector<GoldenResult>& results) {
  Figures figures;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const GoldenResult& result = results[i];
    const std::string at = "/goldens/" + std::to_string(i);
    figures[at + "/name"] = result.golden.name;
    figures[at + "/passed"] = result.passed;
    figures[at + "/verdict"] = result.verdict;
    figures[at + "/same_bytes"] = result.difference.same_bytes;
    figures[at + "/flip_mean"] = result.difference.flip_mean;
    figures[at + "/worst_window_pixels"] = std::int64_t{result.difference.worst_window_pixels};
    figures[at + "/renderer"] = result.renderer;
  }
  return format_figures(figures);
}

std::string pixel_hash(const render::Image& image) {
  std::uint64_t hash =
      combine(static_cast<std::uint64_t>(image.width), static_cast<std::uint64_t>(image.height));
  for (const std::uint8_t byte : image.rgb) hash = combine(hash, byte);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Frame without_unused_meshes(const Frame& frame) {
  Frame smaller = frame;
  MeshStore used;
  std::vector<MeshIndex> new_of_old(frame.meshes->size());
  for (Instance& instance : smaller.instances) {
    MeshIndex& index = new_of_old[instance.mesh.value];
    if (index.none()) {
      index = MeshIndex(used.size());
      used.push_back((*frame.meshes)[instance.mesh.value]);
    }
    instance.mesh = index;
  }
  smaller.meshes = std::make_shared<const MeshStore>(std::move(used));
  return smaller;
}

}  // namespace sunder::app
