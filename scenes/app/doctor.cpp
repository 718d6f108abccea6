// sunder doctor: reports what the program finds on this machine, what is missing, and the Debian
// package that has it.
//
// Read first: doctor(). Each check_*() function makes one or a few findings.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/figures.h"
#include "engine/io/statistics.h"
#include "render/gl/tried_contexts.h"
#include "scenes/app/build_info.h"
#include "scenes/app/commands.h"
#include "scenes/file/mesh_cache.h"
#include "scenes/make_simulation.h"
#include "scenes/timing/machine.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;

enum class State { kGood, kMissing, kFailed };

/// Something that was looked for on this machine.
struct Finding {
  const char* name;
  State state = State::kGood;
  std::string text;
  std::string remedy = {};  ///< Empty if the state is good.
};

/// The findings, and the figures of --json.
struct Report {
  std::vector<Finding> findings;
  Figures figures;
};

const char* name_of(State state) {
  if (state == State::kGood) return "good";
  return state == State::kMissing ? "missing" : "failed";
}

std::string megabytes_text(double bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.0f MB", bytes / 1e6);
  return text;
}

void report_build(Report& report) {
  report.figures = build_figures();
  report.figures["/version"] = build_info().version;
}

void check_processor(Report& report) {
  const int lanes = solver::lanes_in_use(0);
  report.findings.push_back({"processor", State::kGood,
                             cpu_name() + ", " + std::to_string(lanes) + " lanes in use (" +
                                 scenes::instructions_of(lanes) + ")"});
  report.findings.push_back({"threads", State::kGood, std::to_string(threads())});
  report.figures["/cpu"] = cpu_name();
  report.figures["/lanes"] = std::int64_t{lanes};
  report.figures["/threads"] = std::int64_t{threads()};
}

void check_scenes(Report& report) {
  Finding& finding = report.findings.emplace_back(Finding{"scenes", State::kGood, {}});
  try {
    const std::string folder = scenes::scenes_folder().string();
    finding.text = std::to_string(scenes::catalog().size()) + " in " + folder;
    report.figures["/scenes_folder"] = folder;
  } catch (const InputError& error) {
    finding = {"scenes", State::kMissing, error.what(),
               "install the scenes with the program; scene files of your own work without them"};
  }
}

constexpr const char* kSmallScene = R"(
[scene]
description = "two boxes"
duration_s = 1
[[body]]
mesh = "box:1,1,1"
position = [0, 0.5, 0]
[[body]]
mesh = "box:1,1,1"
position = [0, 1.6, 0]
)";

/// Simulates ten frames of two boxes.
void check_simulating(Report& report) {
  Finding& finding = report.findings.emplace_back(Finding{"simulating", State::kGood, {}});
  try {
    const auto simulation = scenes::make_simulation(scenes::parse_scene(kSmallScene, "two boxes"));
    StateHash hash;
    for (int frame = 0; frame < 10; ++frame) hash.take(simulation->next());
    finding.text = "ten frames of two boxes, state hash " + hash.hex();
    report.figures["/state_hash"] = hash.hex();
  } catch (const std::exception& error) {
    finding = {"simulating", State::kFailed, error.what(), "build or install the program again"};
  }
}

void check_drawing(Report& report) {
  const std::vector<render::TriedContext> tried = render::try_contexts();
  std::string reasons, used;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const render::TriedContext& context = tried[i];
    const std::string at = "/gl/" + std::to_string(i);
    const bool works = context.reason.empty();
    report.figures[at + "/kind"] = context.kind;
    report.figures[at + "/works"] = works;
    report.figures[at + "/text"] = works ? context.description : context.reason;
    report.figures[at + "/used"] = works && used.empty();
    if (works) {
      report.findings.push_back(
          {used.empty() ? "drawing" : "", State::kGood,
           context.description + (used.empty() ? ", used by --gl auto" : "")});
      if (used.empty()) used = context.kind;
    } else {
      reasons += (reasons.empty() ? "" : "; ") + context.reason;
    }
  }
  if (used.empty()) {
    report.findings.push_back({"drawing", State::kFailed, "no OpenGL context: " + reasons,
                               "apt-get install libegl1 libgl1-mesa-dri"});
  } else if (!reasons.empty()) {
    report.findings.push_back({"", State::kGood, "not available: " + reasons});
  }
}

/// Returns the output of a shell command, or nothing if it fails.
std::string output_of(const char* command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command, "r"), ::pclose);
  std::string text;
  char part[4096];
  while (pipe) {
    const std::size_t size = std::fread(part, 1, sizeof part, pipe.get());
    if (size == 0) break;
    text.append(part, size);
  }
  return text;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void check_ffmpeg(Report& report) {
  Finding& finding = report.findings.emplace_back(Finding{"videos", State::kGood, {}});
  const std::string path = first_line(output_of("command -v ffmpeg 2>/dev/null"));
  const std::string version = first_line(output_of("ffmpeg -version 2>/dev/null"));
  if (path.empty() || version.empty()) {
    finding = {"videos", State::kMissing, "the program ffmpeg is missing; images need none",
               "apt-get install ffmpeg"};
    return;
  }
  report.figures["/ffmpeg/path"] = path;
  report.figures["/ffmpeg/version"] = version;
  finding.text = path + ": " + first_line(version);
  const std::string encoders = output_of("ffmpeg -hide_banner -encoders 2>/dev/null");
  struct Encoder {
    const char *name, *key, *ending;
  };
  for (const auto& [name, key, ending] :
       {Encoder{"libx264", "h264", ".mp4"}, {"libvpx-vp9", "vp9", ".webm"}}) {
    const bool has = encoders.find(std::string(" ") + name + " ") != std::string::npos;
    report.figures[std::string("/ffmpeg/") + key] = has;
    if (has) continue;
    finding.state = State::kMissing;
    finding.text += std::string("; it has no encoder ") + name + " for " + ending;
    finding.remedy = "install Debian's ffmpeg: apt-get install ffmpeg";
  }
}

/// Returns the folder, or its nearest parent that exists.
fs::path existing(fs::path folder) {
  std::error_code ignored;
  while (!folder.empty() && folder != folder.parent_path() && !fs::exists(folder, ignored))
    folder = folder.parent_path();
  return folder;
}

bool is_writable(const fs::path& folder) { return ::access(folder.c_str(), W_OK | X_OK) == 0; }

void check_cache(Report& report) {
  const fs::path folder = scenes::cache_folder();
  if (folder.empty()) {
    report.findings.push_back({"cache", State::kMissing, "no folder: meshes are decomposed anew",
                               "set HOME or SUNDER_CACHE"});
    return;
  }
  double bytes = 0;
  std::int64_t files = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code gone;
    const auto size = entry->file_size(gone);
    if (gone) continue;
    bytes += static_cast<double>(size);
    ++files;
  }
  report.figures["/cache/folder"] = folder.string();
  report.figures["/cache/files"] = files;
  report.figures["/cache/size_MB"] = bytes / 1e6;
  const std::string text = folder.string() + ", " + std::to_string(files) + " meshes, " +
                           megabytes_text(bytes) + "; may be deleted at any time";
  if (is_writable(existing(folder))) {
    report.findings.push_back({"cache", State::kGood, text});
  } else {
    report.findings.push_back({"cache", State::kMissing, folder.string() + " cannot be written",
                               "set SUNDER_CACHE to a folder of your own"});
  }
}

/// Checks that results can be written to the working directory.
void check_disk(Report& report) {
  constexpr double kEnough_bytes = 1e9;
  std::error_code error;
  const fs::path here = fs::current_path(error);
  const double bytes = static_cast<double>(fs::space(here, error).available);
  if (error) {
    report.findings.push_back({"disk", State::kMissing, "the working directory cannot be read",
                               "change to another folder"});
    return;
  }
  report.figures["/disk/folder"] = here.string();
  report.figures["/disk/free_MB"] = bytes / 1e6;
  report.figures["/disk/writable"] = is_writable(here);
  Finding& finding = report.findings.emplace_back(
      Finding{"disk", State::kGood, megabytes_text(bytes) + " free in " + here.string()});
  if (!is_writable(here)) {
    finding = {"disk", State::kMissing, here.string() + " cannot be written",
               "write results to another folder, by -o"};
  } else if (bytes < kEnough_bytes) {
    finding.state = State::kMissing;
    finding.remedy = "free some room: a video or its images may need more";
  }
}

std::string table_of(const Report& report) {
  std::string text = version_line() + "\n";
  for (const Finding& finding : report.findings) {
    char head[40];
    std::snprintf(head, sizeof head, "%-9s%-12s", *finding.name ? name_of(finding.state) : "",
                  finding.name);
    text += head + finding.text + "\n";
    if (!finding.remedy.empty()) text += std::string(21, ' ') + "-> " + finding.remedy + "\n";
  }
  return text;
}

}  // namespace

int doctor(const DoctorOptions& options) {
  options.apply();
  Report report;
  report_build(report);
  check_processor(report);
  check_scenes(report);
  check_simulating(report);
  check_drawing(report);
  check_ffmpeg(report);
  check_cache(report);
  check_disk(report);
  bool works = true;
  std::size_t index = 0;
  for (const Finding& finding : report.findings) {
    if (finding.state == State::kFailed) works = false;
    if (*finding.name == 0) continue;
    const std::string at = "/findings/" + std::to_string(index++);
    report.figures[at + "/name"] = std::string(finding.name);
    report.figures[at + "/state"] = std::string(name_of(finding.state));
    report.figures[at + "/text"] = finding.text;
    if (!finding.remedy.empty()) report.figures[at + "/remedy"] = finding.remedy;
  }
  report.figures["/works"] = works;
  options.print(table_of(report));
  options.write_json(format_figures(report.figures));
  return works ? 0 : 1;
}

}  // namespace sunder::app
