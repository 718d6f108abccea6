#include "bench/ablation/report.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bench/truths/truth.h"

namespace sunder::ablation {
namespace {

constexpr double kMuch = 1.5, kOfMark = 0.1, kBroken = 1e300;

/// Least and most that an error came to.
struct Range {
  double least = kBroken, most = 0;

  void add(double error) { least = std::min(least, error), most = std::max(most, error); }
};

double error_of(const Trial& trial, std::size_t truth, std::size_t preset) {
  const auto found = trial.truths.find({truth, preset});
  return found == trial.truths.end() || !std::isfinite(found->second) ? kBroken
                                                                      : std::abs(found->second);
}

std::string shortly(double error) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", error);
  return error >= kBroken ? "broke down" : text;
}

struct Changed {
  std::string better, worse;  ///< Lines of a list.
  int betters = 0, worses = 0;
};

Changed compare(const Trial& trial, const std::vector<Trial>& noise) {
  static const truths::Truths all = truths::all_truths();
  Changed changed;
  for (const auto& [key, value] : noise.front().truths) {
    const auto [truth, preset] = key;
    Range range;
    for (const Trial& other : noise) range.add(error_of(other, truth, preset));
    const double floor = kOfMark * all[truth].mark, error = error_of(trial, truth, preset);
    const bool worse = error > kMuch * std::max(range.most, floor);
    const bool better = range.least > kMuch * std::max(error, floor);
    if (!worse && !better) continue;
    ++(worse ? changed.worses : changed.betters);
    const std::string line = std::string("* ") + (worse ? "worse" : "better") + ", " +
                             truths::kPresets[preset].name + ": " + all[truth].what + ": " +
                             shortly(std::abs(value)) + " → " + shortly(error) + " " +
                             all[truth].unit + " (mark " + shortly(all[truth].mark) + ")\n";
    (worse ? changed.worse : changed.better) += line;
  }
  return changed;
}

std::string off_of(const Rule& rule) {
  std::string text;
  for (const Change& change : rule.off)
    text += (text.empty() ? "" : ", ") + change.number + " = " + shortly(change.value);
  return text;
}

void print_piles(const std::vector<Rule>& rules, const std::vector<Trial>& trials) {
  const std::vector<std::string> names = pile_names();
  std::printf("\n| off |");
  for (const std::string& name : names) std::printf(" %s |", name.c_str());
  std::printf("\n|---|");
  for (std::size_t i = 0; i < names.size(); ++i) std::printf("---|");
  for (std::size_t i = 0; i < rules.size(); ++i) {
    std::printf("\n| %s |", rules[i].name.c_str());
    for (const PileFigures& f : trials[i].piles)
      std::printf(" %.2g, %.2g; %.1e; %.0f %%; × %.2f |", f.mean_mm, f.deepest_mm, f.rms_m_s,
                  100 * f.awake, f.cost);
    for (std::size_t k = trials[i].piles.size(); k < names.size(); ++k)
      std::printf(" broke down |");
  }
  std::printf("\n");
}

}  // namespace

void print_markdown(const std::vector<Rule>& rules, const std::vector<Trial>& trials,
                    std::size_t noise) {
  const std::vector<Trial> as_is(trials.begin(),
                                 trials.begin() + static_cast<std::ptrdiff_t>(noise));
  std::vector<Changed> changed;
  for (const Trial& trial : trials) changed.push_back(compare(trial, as_is));
  std::printf("| off | number | truths worse | better |\n|---|---|---|---|\n");
  for (std::size_t i = noise; i < rules.size(); ++i)
    std::printf("| %s | %s | %d | %d |\n", rules[i].name.c_str(), off_of(rules[i]).c_str(),
                changed[i].worses, changed[i].betters);
  std::printf("\n## Piles\n");
  print_piles(rules, trials);
  std::printf("\n## Truths\n");
  for (std::size_t i = noise; i < rules.size(); ++i) {
    if (changed[i].worses + changed[i].betters == 0) continue;
    std::printf("\n**%s**\n\n%s%s", rules[i].name.c_str(), changed[i].worse.c_str(),
                changed[i].better.c_str());
  }
}

void write_json(const std::vector<Rule>& rules, const std::vector<Trial>& trials, std::FILE* file) {
  const truths::Truths all = truths::all_truths();
  const std::vector<std::string> names = pile_names();
  std::fprintf(file, "[");
  for (std::size_t i = 0; i < rules.size(); ++i) {
    std::fprintf(file, "%s\n{\"off\": \"%s\", \"numbers\": \"%s\", \"truths\": [", i ? "," : "",
                 rules[i].name.c_str(), off_of(rules[i]).c_str());
    const char* comma = "";
    for (const auto& [key, value] : trials[i].truths) {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g", value);
      std::fprintf(file, "%s\n  {\"what\": \"%s\", \"preset\": \"%s\", \"value\": %s}", comma,
                   all[key.first].what, truths::kPresets[key.second].name,
                   std::isfinite(value) ? text : "null");
      comma = ",";
    }
    std::fprintf(file, "],\n \"piles\": [");
    for (std::size_t k = 0; k < trials[i].piles.size(); ++k) {
      const PileFigures& f = trials[i].piles[k];
      std::fprintf(file,
                   "%s\n  {\"pile\": \"%s\", \"mean_mm\": %.4g, \"deepest_mm\": %.4g, "
                   "\"rms_m_s\": %.4g, \"awake\": %.4g, \"cost\": %.4g}",
                   k ? "," : "", names[k].c_str(), f.mean_mm, f.deepest_mm, f.rms_m_s, f.awake,
                   f.cost);
    }
    std::fprintf(file, "]}");
  }
  std::fprintf(file, "\n]\n");
}

}  // namespace sunder::ablation
