#include "scenes/timing/ratio.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "engine/base/check.h"

namespace sunder::scenes {
namespace {

constexpr double kMinTime_ms = 1e-6;       // avoids a division by zero
constexpr std::size_t kMaxExactRuns = 60;  // runs of both; more: normal approximation
constexpr double kNormalQuantile = 1.960;  // two-sided, for kConfidence

/// Number of outcomes by value of a count whose distribution is symmetric.
using OutcomeCounts = std::vector<double>;

/// Outcomes by number of heads in `tosses` coin tosses.
OutcomeCounts count_coin_tosses(std::size_t tosses) {
  OutcomeCounts outcomes = {1};
  for (std::size_t i = 0; i < tosses; ++i) {
    outcomes.push_back(0);
    for (std::size_t heads = outcomes.size() - 1; heads > 0; --heads)
      outcomes[heads] += outcomes[heads - 1];
  }
  return outcomes;
}

/// Outcomes by number of pairs, one of `a` and one of `b` values, whose first value is smaller: the
/// coefficients of the Gaussian binomial of a + b over a.
OutcomeCounts count_ordered_pairs(std::size_t a, std::size_t b) {
  OutcomeCounts outcomes(a * b + 1, 0);
  outcomes[0] = 1;
  for (std::size_t i = 1; i <= a; ++i) {
    for (std::size_t k = outcomes.size(); k-- > b + i;) outcomes[k] -= outcomes[k - b - i];
    for (std::size_t k = i; k < outcomes.size(); ++k) outcomes[k] += outcomes[k - i];
  }
  return outcomes;
}

/// Number of values outside each end of an interval, and the confidence of the interval.
struct Ends {
  std::size_t left_out = 0;
  double confidence = 0;
};

Ends exact_ends(const OutcomeCounts& outcomes) {
  const double all = std::accumulate(outcomes.begin(), outcomes.end(), 0.0);
  Ends ends;
  double beyond = 0;
  for (std::size_t k = 0; 2 * k + 1 < outcomes.size(); ++k) {
    beyond += 2 * outcomes[k] / all;
    if (k > 0 && beyond > 1 - kConfidence) break;
    ends = {k, std::max(0.0, 1 - beyond)};
  }
  return ends;
}

Ends normal_ends(double mean, double variance) {
  const double left_out = std::floor(mean - kNormalQuantile * std::sqrt(variance)) - 1;
  return {static_cast<std::size_t>(std::max(0.0, left_out)), kConfidence};
}

}  // namespace

RatioInterval ratio_interval(std::span<const double> now, std::span<const double> before,
                             bool paired) {
  SUNDER_CHECK(!now.empty() && !before.empty());
  const auto ratio = [](double a, double b) {
    return std::max(a, kMinTime_ms) / std::max(b, kMinTime_ms);
  };
  std::vector<double> ratios;
  Ends ends;
  const std::size_t a = now.size(), b = before.size();
  const auto n = static_cast<double>(a), m = static_cast<double>(b);
  if (paired && a == b) {
    for (std::size_t i = 0; i < a; ++i) ratios.push_back(ratio(now[i], before[i]));
    ends = a <= kMaxExactRuns ? exact_ends(count_coin_tosses(a)) : normal_ends(n / 2, n / 4);
  } else {
    for (const double after : now) {
      for (const double earlier : before) ratios.push_back(ratio(after, earlier));
    }
    ends = a + b <= kMaxExactRuns ? exact_ends(count_ordered_pairs(a, b))
                                  : normal_ends(n * m / 2, n * m * (n + m + 1) / 12);
  }
  std::ranges::sort(ratios);
  return {ratios[ends.left_out], ratios[ratios.size() - 1 - ends.left_out], ends.confidence};
}

}  // namespace sunder::scenes
