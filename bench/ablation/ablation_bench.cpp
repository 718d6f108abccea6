// What each rule of the rigid solver buys: it is turned off by its number in
// solver/rigid/tuning.h, and reference behaviour and piles are measured without it. The page
// docs/ablation.md is what this prints.
//
//   ablation_bench [--rule SUBSTRING] [--set NUMBER=VALUE,...;...] [--preset NAME] [--jobs N]
//                  [--json FILE]
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "bench/ablation/report.h"
#include "bench/ablation/rules.h"
#include "bench/flags.h"
#include "bench/truths/truth.h"

namespace sunder::ablation {
namespace {

struct Options {
  std::string rule, set, preset, json;
  int jobs = 2;
};

std::vector<Rule> chosen_rules(const Options& options) {
  const std::vector<Rule> all = all_rules();
  std::vector<Rule> chosen(all.begin(), all.begin() + kNoise);
  for (const Rule& rule : parse_rules(options.set)) chosen.push_back(rule);
  if (options.set.empty() || !options.rule.empty())
    for (std::size_t i = kNoise; i < all.size(); ++i)
      if (all[i].name.find(options.rule) != std::string::npos) chosen.push_back(all[i]);
  for (const Rule& rule : chosen)
    for (const Change& change : rule.off) set_number(change.number, set_number(change.number, 0));
  return chosen;
}

/// By number; realtime and accurate unless one is named. Empty: there is none of that name.
std::vector<std::size_t> chosen_presets(const Options& options) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < truths::kPresets.size(); ++i)
    if (options.preset.empty() ? i == 1 || i == 2 : options.preset == truths::kPresets[i].name)
      chosen.push_back(i);
  return chosen;
}

int run(const Options& options) {
  const std::vector<Rule> rules = chosen_rules(options);
  const std::vector<std::size_t> presets = chosen_presets(options);
  if (presets.empty() || options.jobs < 1) return 2;
  const std::vector<Trial> trials = try_all(rules, presets, options.jobs);
  print_markdown(rules, trials, kNoise);
  if (options.json.empty()) return 0;
  std::FILE* file = std::fopen(options.json.c_str(), "w");
  if (file == nullptr) {
    std::fprintf(stderr, "cannot write %s\n", options.json.c_str());
    return 1;
  }
  write_json(rules, trials, file);
  return std::fclose(file) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace sunder::ablation

int main(int argc, char** argv) {
  sunder::ablation::Options options;
  bool good = sunder::bench::read_flags(argc, argv,
                                        {{"--rule", &options.rule},
                                         {"--set", &options.set},
                                         {"--preset", &options.preset},
                                         {"--jobs", &options.jobs},
                                         {"--json", &options.json}});
  try {
    const int status = good ? sunder::ablation::run(options) : 2;
    if (status != 2) return status;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  std::fprintf(stderr,
               "usage: %s [--rule SUBSTRING] [--set NUMBER=VALUE,...;...] "
               "[--preset draft|realtime|accurate|reference] [--jobs N] [--json FILE]\n",
               argv[0]);
  return 2;
}
