#include "bench/truths/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "engine/base/cpu_time.h"
#include "tests/fixtures/flags.h"

namespace sunder::truths {
namespace {

struct Options {
  std::string only, preset, json;
  bool markdown = false;
};

/// Result of a case at one preset.
struct Figure {
  std::size_t preset = 0;
  double value = 0, cpu_s = 0;
  std::string told;
};
struct Line {
  Truth truth;
  std::vector<Figure> figures;
};

bool misses(double value, double most) { return !(std::abs(value) <= most); }

std::string format_short(double value, int digits) {
  char text[32];
  if (std::abs(value) >= 100 && std::abs(value) < 1e6)
    std::snprintf(text, sizeof text, "%.0f", value);
  else
    std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string format_mark(const Truth& truth) {
  return format_short(truth.mark, 3) + (*truth.unit ? " " : "") + truth.unit;
}

Line measure(const Truth& truth, const Options& options) {
  Line line{truth, {}};
  for (std::size_t i = 0; i < kPresets.size(); ++i) {
    if (!options.preset.empty() && options.preset != kPresets[i].name) continue;
    const double start_ms = cpu_ms();
    const double value = truth.measure(kPresets[i]);
    const double cpu_s = 1e-3 * (cpu_ms() - start_ms);
    line.figures.push_back({i, value, cpu_s, truth.told ? truth.told(kPresets[i]) : ""});
  }
  return line;
}

void print_head(const Options& options) {
  std::printf("| row | what | reference | source | mark |");
  for (const Preset& preset : kPresets)
    if (options.preset.empty() || options.preset == preset.name) std::printf(" %s |", preset.name);
  std::printf("\n|---|---|---|---|---|");
  for (const Preset& preset : kPresets)
    if (options.preset.empty() || options.preset == preset.name) std::printf("---|");
  std::printf("\n");
}

void print_markdown(const Line& line) {
  const Truth& truth = line.truth;
  std::printf("| %d | %s | %s | %s | %s |", truth.row, truth.what, truth.source,
              name_of(source_kind(truth)), format_mark(truth).c_str());
  for (const Figure& figure : line.figures) {
    const char* bold = misses(figure.value, truth.mark) ? "**" : "";
    const char* warned = figure.told.empty() ? "" : " †";
    std::printf(" %s%s%s%s |", bold, format_short(figure.value, 2).c_str(), bold, warned);
  }
  std::printf("\n");
}

/// Prints each warning once, with the case and preset where it first appears.
void print_warnings(const std::vector<Line>& lines) {
  std::set<std::string> seen;
  for (const Line& line : lines) {
    // Finer presets have the same warnings with other numbers, so only the first preset counts.
    const auto first =
        std::ranges::find_if(line.figures, std::not_fn(&std::string::empty), &Figure::told);
    if (first == line.figures.end() || !seen.insert(first->told).second) continue;
    std::printf("%s* %s, `%s`: %s\n", seen.size() > 1 ? "" : "\n† Warnings that the user gets:\n\n",
                line.truth.what, kPresets[first->preset].name, first->told.c_str());
  }
}

void print_plain(const Line& line) {
  const Truth& truth = line.truth;
  std::printf("%2d %s (mark %s)\n", truth.row, truth.what, format_mark(truth).c_str());
  for (const Figure& figure : line.figures) {
    const double bound = truth.bounds[figure.preset];
    std::printf("     %-10s %10.3g %s%s%s   %.1f s\n", kPresets[figure.preset].name, figure.value,
                truth.unit, misses(figure.value, truth.mark) ? "  misses its mark" : "",
                misses(figure.value, bound) ? "  and its BOUND" : "", figure.cpu_s);
    if (!figure.told.empty()) std::printf("       %s\n", figure.told.c_str());
  }
}

void write_json(std::FILE* file, const std::vector<Line>& lines) {
  std::fprintf(file, "[");
  for (const Line& line : lines) {
    const Truth& truth = line.truth;
    std::fprintf(file, "%s\n{\"row\": %d, \"what\": \"%s\", \"unit\": \"%s\", \"source\": \"%s\",",
                 &line == &lines.front() ? "" : ",", truth.row, truth.what, truth.unit,
                 truth.source);
    std::fprintf(file, " \"kind\": \"%s\", \"mark\": %.17g, \"presets\": {",
                 name_of(source_kind(truth)), truth.mark);
    for (const Figure& figure : line.figures) {
      char value[32];
      std::snprintf(value, sizeof value, "%.17g", figure.value);
      std::fprintf(file,
                   "%s\"%s\": {\"value\": %s, \"bound\": %.17g, \"cpu_s\": %.3f, \"warned\": %s}",
                   &figure == &line.figures.front() ? "" : ", ", kPresets[figure.preset].name,
                   std::isfinite(figure.value) ? value : "null", truth.bounds[figure.preset],
                   figure.cpu_s, figure.told.empty() ? "false" : "true");
    }
    std::fprintf(file, "}}");
  }
  std::fprintf(file, "\n]\n");
}

/// Returns false if the file cannot be written.
bool write_json(const std::string& name, const std::vector<Line>& lines) {
  std::FILE* file = name == "-" ? stdout : std::fopen(name.c_str(), "w");
  if (file == nullptr) return false;
  write_json(file, lines);
  return (file == stdout ? std::fflush(file) : std::fclose(file)) == 0;
}

int run(const Options& options, const Truths& truths) {
  const bool table = options.json != "-";
  if (table && options.markdown) print_head(options);
  std::vector<Line> lines;
  for (const Truth& truth : truths) {
    if (std::string(truth.what).find(options.only) == std::string::npos) continue;
    const bool own = source_kind(truth) == SourceKind::kOwn;
    if (table && options.markdown && own && !lines.empty() &&
        source_kind(lines.back().truth) != SourceKind::kOwn) {
      std::printf(
          "\n## Own formulas\n\nNo truths: these rows compare with what Sunder computes by itself, "
          "or "
          "with Sunder at another preset.\n\n");
      print_head(options);
    }
    lines.push_back(measure(truth, options));
    if (table) (options.markdown ? print_markdown : print_plain)(lines.back());
    std::fflush(stdout);
  }
  if (table && options.markdown) print_warnings(lines);
  if (!options.json.empty() && !write_json(options.json, lines)) {
    std::fprintf(stderr, "cannot write %s\n", options.json.c_str());
    return 1;
  }
  return 0;
}

bool is_preset(const std::string& preset) {
  for (const Preset& other : kPresets)
    if (preset == other.name) return true;
  return preset.empty();
}

}  // namespace

int table_main(int argc, char** argv, const Truths& truths) {
  Options options;
  if (!read_flags(argc, argv,
                  {{"--only", &options.only, "SUBSTRING"},
                   {"--preset", &options.preset, "draft|realtime|accurate|reference"},
                   {"--markdown", &options.markdown},
                   {"--json", &options.json, "FILE|-"}},
                  [&] { return is_preset(options.preset); }))
    return kUsageError;
  return run(options, truths);
}

}  // namespace sunder::truths
