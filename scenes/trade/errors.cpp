#include "scenes/trade/errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/io/statistics.h"

namespace sunder::scenes {
namespace {

constexpr double kRelativeFloor = 0.01;  // relative to the mean magnitude
constexpr std::pair<std::string_view, double> kUnitFloors[] = {{"penetration worst m", 1e-2},
                                                               {" m", 1e-3},
                                                               {" m/s", 0.01},
                                                               {" rad/s", 0.01},
                                                               {" share", 0.01},
                                                               {" J/kg", 0.01},
                                                               {"pieces", 1}};
constexpr int kSplits = 64;             // random halves of the reference's seeds
constexpr double kNoiseQuantile = 0.9;  // of pairs that differ by less than the noise

using Samples = std::vector<double>;

/// Returns, by name, the samples of each run that has any.
std::map<std::string, std::vector<Samples>> by_name(std::span<const Facts> runs) {
  std::map<std::string, std::vector<Samples>> all;
  for (const Facts& facts : runs)
    for (const auto& [name, samples] : facts.samples)
      if (!samples.empty()) all[name].push_back(samples);
  return all;
}

Samples pooled(std::span<const Samples> runs) {
  Samples all;
  for (const Samples& run : runs) all.insert(all.end(), run.begin(), run.end());
  return all;
}

/// Returns the difference due to chance of `point` seeds from all seeds of the reference.
double chance_difference(std::vector<Samples> reference, std::size_t point) {
  const std::size_t half = reference.size() / 2;
  if (half == 0) return 0;
  Random random(1);
  Samples distances;
  for (int split = 0; split < kSplits; ++split) {
    for (std::size_t i = 0; i + 1 < reference.size(); ++i) {
      const auto left = static_cast<std::uint32_t>(reference.size() - i);
      std::swap(reference[i], reference[i + random.below(left)]);
    }
    const std::span<const Samples> all(reference);
    distances.push_back(distance_between(pooled(all.first(half)), pooled(all.subspan(half, half))));
  }
  const double sets =
      1.0 / static_cast<double>(point) + 1.0 / static_cast<double>(reference.size());
  return quantile(distances, kNoiseQuantile) * std::sqrt(sets * static_cast<double>(half) / 2);
}

}  // namespace

double distance_between(std::vector<double> a, std::vector<double> b) {
  SUNDER_CHECK(!a.empty() && !b.empty());
  const auto is_finite = [](double sample) { return std::isfinite(sample); };
  if (!std::ranges::all_of(a, is_finite) || !std::ranges::all_of(b, is_finite))
    return std::numeric_limits<double>::infinity();
  std::ranges::sort(a);
  std::ranges::sort(b);
  const double of_a = 1.0 / static_cast<double>(a.size());
  const double of_b = 1.0 / static_cast<double>(b.size());
  double distance = 0, at = std::min(a[0], b[0]);
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    const bool is_a = j == b.size() || (i < a.size() && a[i] <= b[j]);
    const double next = is_a ? a[i] : b[j];
    const double apart = static_cast<double>(i) * of_a - static_cast<double>(j) * of_b;
    distance += std::abs(apart) * (next - at);
    at = next;
    ++(is_a ? i : j);
  }
  return distance;
}

double noise_floor(std::string_view name, std::span<const double> reference) {
  double sum = 0;
  for (const double sample : reference) sum += std::abs(sample);
  const double mean = reference.empty() ? 0 : sum / static_cast<double>(reference.size());
  const auto unit =
      std::ranges::find_if(kUnitFloors, [&](const auto& one) { return name.ends_with(one.first); });
  SUNDER_CHECK(unit != std::end(kUnitFloors));
  return std::max(kRelativeFloor * mean, unit->second);
}

std::vector<TradeError> trade_errors(std::span<const Facts> point,
                                     std::span<const Facts> reference) {
  SUNDER_CHECK(!reference.empty());
  const auto found = by_name(point);
  std::vector<TradeError> errors;
  for (const auto& [name, runs] : by_name(reference)) {
    const auto at = found.find(name);
    if (at == found.end()) continue;
    const Samples all = pooled(runs);
    TradeError error{name, distance_between(pooled(at->second), all)};
    error.noise = std::max(chance_difference(runs, at->second.size()), noise_floor(name, all));
    error.over_noise = error.distance / error.noise;
    errors.push_back(std::move(error));
  }
  return errors;
}

double worst(std::span<const TradeError> errors) {
  double largest = 0;
  for (const TradeError& error : errors) largest = std::max(largest, error.over_noise);
  return largest;
}

}  // namespace sunder::scenes
