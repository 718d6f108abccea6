#include "scenes/timing/judge.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/printed.h"
#include "engine/io/statistics.h"

namespace sunder::scenes {
namespace {

constexpr double kBoundOfP99 = 2, kBoundOfMax = 4;  // times that of the mean
constexpr const char* kNamesOfBounds[] = {"mean", "p50", "p95", "p99", "max", "memory", "draw"};
constexpr double kLeastMemory_MB = 1e-3;

/// Returns the fraction for a percentage, 0.1 for "10%" or "10".
double parse_percent(const std::string& flag, const std::string& text) {
  double percent = 0;
  const std::string digits = text.ends_with('%') ? text.substr(0, text.size() - 1) : text;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, percent);
  if (error != std::errc() || stop != end || !(percent >= 0) || !std::isfinite(percent)) {
    throw InputError(flag + " " + text +
                     ": expected a percentage of at least 0, such as 10%, and maybe others for "
                     "single figures, such as 10%,max=50%");
  }
  return percent / 100;
}

/// Returns the name by which --fail-slower has the bound of a figure.
std::string bound_name(const PairedFigure& pair) {
  return pair.what == "memory" || pair.what == "draw" ? pair.what : pair.figure;
}

double noise_of(const PairedFigure& pair) {
  return pair.what == "memory" ? kLeastMemory_MB : kNoise_ms;
}

/// Returns the error with which each of `figures` is judged.
double error_of_each(std::size_t figures) {
  return kJudgeError / static_cast<double>(std::max<std::size_t>(figures, 1));
}

/// Number of repeats in which the first of two values is greater.
std::size_t count_more(const std::vector<double>& a, const std::vector<double>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] > b[i] ? 1 : 0;
  return count;
}

/// Judges stalls by the repeats in which the programs have different numbers of them.
void judge_stalls(Judged& judged, double error) {
  const std::size_t more = count_more(judged.pair.now, judged.pair.before);
  const std::size_t fewer = count_more(judged.pair.before, judged.pair.now);
  judged.judgement = Judgement::kSame;
  if (heads_probability(more, more + fewer) <= error) judged.judgement = Judgement::kSlower;
  if (heads_probability(fewer, more + fewer) <= error) judged.judgement = Judgement::kFaster;
  judged.fails = judged.judgement == Judgement::kSlower;
}

void judge_ratio(Judged& judged, double error) {
  judged.interval =
      ratio_interval(judged.pair.now, judged.pair.before, noise_of(judged.pair), error);
  if (!judged.interval) return;
  judged.judgement = judged.interval->low > 1    ? Judgement::kSlower
                     : judged.interval->high < 1 ? Judgement::kFaster
                                                 : Judgement::kSame;
  judged.fails = judged.interval->low > 1 + judged.bound;
}

std::string number(double value) { return printed("%.4g", value); }

Verdict verdict_of(const Judged& judged) {
  Verdict verdict{judged.scene, kFigure + judged.pair.name(), Outcome::kPassed, {}};
  if (judged.pair.unit == "ms of wall time") verdict.what += " (wall)";
  verdict.text = number(judged.before) + " " + judged.pair.unit + " before, " + number(judged.now) +
                 " now; change " + judged.interval_text();
  if (judged.judgement == Judgement::kTooFew) verdict.outcome = Outcome::kSkipped;
  if (!judged.fails) return verdict;
  verdict.outcome = Outcome::kFailed;
  verdict.text += judged.pair.figure == "stalls"
                      ? ", more stalls"
                      : printed(", slower by more than %.4g %%", 100 * judged.bound);
  return verdict;
}

}  // namespace

const char* name_of(Judgement judgement) {
  switch (judgement) {
    case Judgement::kTooFew:
      return "too few repeats";
    case Judgement::kSame:
      return "no difference";
    case Judgement::kSlower:
      return "slower";
    case Judgement::kFaster:
      return "faster";
  }
  return "";
}

Bounds parse_bounds(const std::string& flag, const std::string& text) {
  const std::size_t first_end = std::min(text.find(','), text.size());
  const double first = parse_percent(flag, text.substr(0, first_end));
  Bounds bounds;
  for (const std::string name : kNamesOfBounds) bounds[name] = first;
  bounds["p99"] *= kBoundOfP99;
  bounds["max"] *= kBoundOfMax;
  for (std::size_t start = first_end + 1; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    const std::string part = text.substr(start, end - start);
    const std::size_t equals = std::min(part.find('='), part.size());
    const auto bound = bounds.find(part.substr(0, equals));
    if (bound == bounds.end() || equals == part.size()) {
      throw InputError(flag + " " + text + ": '" + part +
                       "': expected FIGURE=PERCENT, of mean, p50, p95, p99, max, memory and draw");
    }
    bound->second = parse_percent(flag, part.substr(equals + 1));
    start = end + 1;
  }
  return bounds;
}

std::string Judged::interval_text() const {
  if (pair.figure == "stalls") {
    return printed("%zu repeats have more, %zu fewer", count_more(pair.now, pair.before),
                   count_more(pair.before, pair.now));
  }
  if (!interval) return "unknown";
  if (pair.what != "memory" && std::max(before, now) < kNoise_ms)
    return printed("below %.1f ms", kNoise_ms);
  return printed("%+.1f to %+.1f %%", 100 * (interval->low - 1), 100 * (interval->high - 1));
}

std::size_t least_repeats(std::size_t figures) { return least_pairs(error_of_each(figures)); }

Judgements judge(std::span<const ScenePairs> scenes, const std::optional<Bounds>& bounds) {
  Judgements all;
  for (const ScenePairs& scene : scenes) {
    for (const PairedFigure& pair : scene.figures) {
      Judged& judged = all.figures.emplace_back();
      judged.scene = scene.scene;
      judged.pair = pair;
      judged.before = quantile(pair.before, 0.5);
      judged.now = quantile(pair.now, 0.5);
      if (bounds && bounds->contains(bound_name(pair))) judged.bound = bounds->at(bound_name(pair));
    }
  }
  if (all.figures.empty()) return all;
  const auto repeats_of = [](const Judged& judged) { return judged.pair.now.size(); };
  all.repeats = repeats_of(*std::ranges::min_element(all.figures, {}, repeats_of));
  all.least_repeats = least_repeats(all.figures.size());
  const double error = error_of_each(all.figures.size());
  for (Judged& judged : all.figures) {
    if (repeats_of(judged) >= all.least_repeats) {
      if (judged.pair.figure == "stalls") {
        judge_stalls(judged, error);
      } else {
        judge_ratio(judged, error);
      }
    }
    judged.fails = judged.fails && bounds;
    all.verdicts.push_back(verdict_of(judged));
  }
  return all;
}

Judgements judge(std::span<const Figures> scenes, const std::optional<Bounds>& bounds) {
  std::vector<ScenePairs> pairs;
  for (const Figures& scene : scenes) pairs.push_back({text_at(scene, "/scene"), pairs_of(scene)});
  return judge(pairs, bounds);
}

void put_judgements(const Judgements& judgements, std::span<Figures> scenes) {
  for (Figures& scene : scenes) {
    std::size_t index = 0;
    for (const Judged& judged : judgements.figures) {
      if (judged.scene != text_at(scene, "/scene")) continue;
      const std::string at = "/against/figures/" + std::to_string(index++);
      scene[at + "/judgement"] = std::string(name_of(judged.judgement));
      scene[at + "/fails"] = judged.fails;
      scene[at + "/bound"] = judged.bound;
      if (!judged.interval) continue;
      scene[at + "/low"] = judged.interval->low;
      scene[at + "/high"] = judged.interval->high;
    }
    if (index == 0) continue;
    scene["/against/judged"] = static_cast<std::int64_t>(judgements.figures.size());
    scene["/against/least_repeats"] = static_cast<std::int64_t>(judgements.least_repeats);
  }
}

std::string judgements_table(const Judgements& judgements) {
  if (judgements.figures.empty()) return {};
  std::string text =
      "scene          figure          unit                     before       now  change\n";
  for (const Judged& judged : judgements.figures) {
    text +=
        printed("%-14s %-15s %-20s %10.4g %9.4g  ", judged.scene.c_str(),
                judged.pair.name().c_str(), judged.pair.unit.c_str(), judged.before, judged.now);
    text += judged.interval_text();
    if (judged.judgement == Judgement::kSlower || judged.judgement == Judgement::kFaster)
      text += std::string("  ") + name_of(judged.judgement);
    text += "\n";
  }
  const std::string figures =
      printed("%zu pairs of runs, %zu figures: ", judgements.repeats, judgements.figures.size());
  if (judgements.has_too_few()) {
    return text + figures + "too few repeats to call anything slower or faster; that takes " +
           std::to_string(judgements.least_repeats) + ", by --repeats, or fewer scenes\n";
  }
  return text + figures +
         printed("at most %.0f %% of commands on identical programs call any of them slower\n",
                 100 * kJudgeError);
}

}  // namespace sunder::scenes
