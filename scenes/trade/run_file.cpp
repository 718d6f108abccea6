#include "scenes/trade/run_file.h"

#include <charconv>
#include <cstring>
#include <sstream>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/bytes.h"
#include "engine/io/figures.h"
#include "engine/io/statistics.h"

namespace sunder::scenes {
namespace {

namespace fs = std::filesystem;

fs::path file_in(const fs::path& folder, const char* kind, const StudyRun& run) {
  return folder / kind / (run.name() + ".json");
}

/// Returns the settings by which the files of different studies are distinguished.
Figures run_settings(const StudyRun& run) {
  Figures figures = {{"/run/scene", run.scene},
                     {"/run/scene_hash", run.scene_hash},
                     {"/run/point", run.point.name},
                     {"/run/preset", run.point.preset},
                     {"/run/steps", "shifted by the seed"},
                     {"/run/program", SUNDER_VERSION}};
  if (run.frames >= 0) figures["/run/frames"] = std::int64_t{run.frames};
  for (std::size_t i = 0; i < run.set.size(); ++i) {
    figures["/run/set/" + std::to_string(i)] = run.set[i];
  }
  return figures;
}

/// Escape and unescape a name as a reference token of a JSON pointer (RFC 6901).
std::string escape_token(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return text;
}
std::string unescape_token(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    name += text[i] != '~' ? text[i] : text[++i] == '1' ? '/' : '~';
  }
  return name;
}

/// Convert between numbers and text: shortest exact digits, separated by spaces.
std::string join(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    text += (text.empty() ? "" : " ") + std::string(digits, end);
  }
  return text;
}
std::vector<double> split(const std::string& text) {
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::from_chars(word.data(), word.data() + word.size(), values.emplace_back());
  }
  return values;
}

constexpr const char* kSamples = "/samples/";

Figures figures_of(const StudyRun& run, const RunResult& result) {
  Figures figures = run_settings(run);
  if (!result.failed.empty()) {
    figures["/failed"] = result.failed;
    return figures;
  }
  figures["/state_hash"] = result.facts.state_hash;
  for (const auto& [name, values] : result.facts.samples) {
    figures[kSamples + escape_token(name)] = join(values);
  }
  return figures;
}

RunResult result_of(const Figures& figures) {
  RunResult result;
  result.failed = text_at(figures, "/failed");
  result.facts.state_hash = text_at(figures, "/state_hash");
  for (const auto& [place, value] : figures) {
    const auto* text = std::get_if<std::string>(&value);
    if (!text || !place.starts_with(kSamples)) continue;
    result.facts.samples[unescape_token(place.substr(std::strlen(kSamples)))] = split(*text);
  }
  return result;
}

bool has_settings(const Figures& stored, const StudyRun& run) {
  Figures kept;
  for (const auto& entry : stored) {
    if (entry.first.starts_with("/run/")) kept.insert(entry);
  }
  return format_figures(kept) == format_figures(run_settings(run));
}

Figures read_figures(const fs::path& file) {
  const std::vector<std::byte> bytes = read_file(file, file_kinds::kFigures);
  std::string text(bytes.size(), ' ');
  std::memcpy(text.data(), bytes.data(), bytes.size());
  return parse_figures(text, file.string());
}

void write_figures(const fs::path& file, const Figures& figures) {
  write_file(file, format_figures(figures));
}

}  // namespace

void write_run(const fs::path& folder, const StudyRun& run, const Ran& ran) {
  write_figures(file_in(folder, "times", run), {{"/cpu_ms", ran.time.cpu_ms},
                                                {"/wall_ms", ran.time.wall_ms},
                                                {"/frames", std::int64_t{ran.time.frames}},
                                                {"/threads", std::int64_t{threads()}},
                                                {"/cpu", cpu_name()}});
  write_figures(file_in(folder, "runs", run), figures_of(run, ran.result));
}

StoredRun read_run(const fs::path& folder, const StudyRun& run) {
  StoredRun stored;
  const fs::path file = file_in(folder, "runs", run), times = file_in(folder, "times", run);
  if (!fs::exists(file)) return {{}, "not run yet"};
  try {
    const Figures figures = read_figures(file);
    if (!has_settings(figures, run)) return {{}, "belongs to another study", true};
    const Figures time = read_figures(times);
    stored.ran.result = result_of(figures);
    stored.ran.time = {number_at(time, "/cpu_ms"), number_at(time, "/wall_ms"),
                       static_cast<int>(number_at(time, "/frames"))};
  } catch (const InputError& error) {
    return {{}, error.what(), true};
  }
  return stored;
}

}  // namespace sunder::scenes
