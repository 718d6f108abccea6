#include "bench/timing/ratio.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "engine/base/check.h"

namespace sunder::bench {
namespace {

constexpr double kLeast_ms = 1e-6;         // divides
constexpr std::size_t kMostExactly = 60;   // runs of both; more are many enough to be normal
constexpr double kNormalQuantile = 1.960;  // of kConfidence, at both ends

/// Numbers of ways, by count, in which a count that is symmetric about its mean can come about.
using Ways = std::vector<double>;

/// Heads of `tosses` coins.
Ways ways_of_coins(std::size_t tosses) {
  Ways ways = {1};
  for (std::size_t i = 0; i < tosses; ++i) {
    ways.push_back(0);
    for (std::size_t heads = ways.size() - 1; heads > 0; --heads) ways[heads] += ways[heads - 1];
  }
  return ways;
}

/// Pairs of one of `a` and one of `b` numbers of which the first is smaller: the coefficients of
/// the Gaussian binomial of a + b over a.
Ways ways_of_pairs(std::size_t a, std::size_t b) {
  Ways ways(a * b + 1, 0);
  ways[0] = 1;
  for (std::size_t i = 1; i <= a; ++i) {
    for (std::size_t k = ways.size(); k-- > b + i;) ways[k] -= ways[k - b - i];
    for (std::size_t k = i; k < ways.size(); ++k) ways[k] += ways[k - i];
  }
  return ways;
}

/// Number of values beyond either end of an interval, and the confidence in what is between them.
struct Ends {
  std::size_t left_out = 0;
  double confidence = 0;
};

Ends ends_by(const Ways& ways) {
  const double all = std::accumulate(ways.begin(), ways.end(), 0.0);
  Ends ends;
  double beyond = 0;
  for (std::size_t k = 0; 2 * k + 1 < ways.size(); ++k) {
    beyond += 2 * ways[k] / all;
    if (k > 0 && beyond > 1 - kConfidence) break;
    ends = {k, std::max(0.0, 1 - beyond)};
  }
  return ends;
}

Ends ends_if_normal(double mean, double variance) {
  const double left_out = std::floor(mean - kNormalQuantile * std::sqrt(variance)) - 1;
  return {static_cast<std::size_t>(std::max(0.0, left_out)), kConfidence};
}

}  // namespace

RatioInterval ratio_interval(std::span<const double> now, std::span<const double> before,
                             bool paired) {
  SUNDER_CHECK(!now.empty() && !before.empty());
  const auto ratio = [](double a, double b) {
    return std::max(a, kLeast_ms) / std::max(b, kLeast_ms);
  };
  std::vector<double> ratios;
  Ends ends;
  const std::size_t a = now.size(), b = before.size();
  const auto n = static_cast<double>(a), m = static_cast<double>(b);
  if (paired && a == b) {
    for (std::size_t i = 0; i < a; ++i) ratios.push_back(ratio(now[i], before[i]));
    ends = a <= kMostExactly ? ends_by(ways_of_coins(a)) : ends_if_normal(n / 2, n / 4);
  } else {
    for (const double after : now) {
      for (const double earlier : before) ratios.push_back(ratio(after, earlier));
    }
    ends = a + b <= kMostExactly ? ends_by(ways_of_pairs(a, b))
                                 : ends_if_normal(n * m / 2, n * m * (n + m + 1) / 12);
  }
  std::ranges::sort(ratios);
  return {ratios[ends.left_out], ratios[ratios.size() - 1 - ends.left_out], ends.confidence};
}

}  // namespace sunder::bench
