#include "scenes/timing/sign_test.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/check.h"

namespace sunder::scenes {

double heads_probability(std::size_t heads, std::size_t tosses) {
  const auto n = static_cast<double>(tosses);
  double sum = 0;
  for (std::size_t k = heads; k <= tosses; ++k) {
    const auto x = static_cast<double>(k);
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(x + 1) - std::lgamma(n - x + 1) -
                    n * std::log(2.0));
  }
  return sum;
}

std::size_t least_pairs(double error) {
  SUNDER_CHECK(error > 0);
  std::size_t pairs = 1;
  for (double all_agree = 0.5; all_agree > error; all_agree /= 2) ++pairs;
  return pairs;
}

std::optional<RatioInterval> ratio_interval(std::span<const double> now,
                                            std::span<const double> before, double least,
                                            double error) {
  SUNDER_CHECK(now.size() == before.size() && least > 0);
  const std::size_t pairs = now.size();
  if (pairs < least_pairs(error)) return std::nullopt;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < pairs; ++i)
    ratios.push_back(std::max(now[i], least) / std::max(before[i], least));
  std::ranges::sort(ratios);
  std::size_t left_out = 0;  // at each end
  while (heads_probability(pairs - left_out - 1, pairs) <= error) ++left_out;
  return RatioInterval{ratios[left_out], ratios[pairs - 1 - left_out]};
}

}  // namespace sunder::scenes
