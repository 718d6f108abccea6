#include "scenes/trade/errors.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/io/statistics.h"

namespace sunder::scenes {
namespace {

constexpr int kResamples = 1000;         // of a confidence interval
constexpr double kTail = 0.05;           // probability below an interval, and above it
constexpr double kRelativeFloor = 0.01;  // relative to the mean magnitude
constexpr std::pair<std::string_view, double> kUnitFloors[] = {{"penetration worst m", 1e-2},
                                                               {" m", 1e-3},
                                                               {" m/s", 0.01},
                                                               {" rad/s", 0.01},
                                                               {" share", 0.01},
                                                               {" J/kg", 0.01},
                                                               {"pieces", 1}};

using Samples = std::vector<double>;

/// Returns the samples of each run, sorted; empty for a run that has none of this name.
std::vector<Samples> sorted_samples(std::span<const Facts> runs, const std::string& name) {
  std::vector<Samples> all;
  for (const Facts& facts : runs) {
    const auto found = facts.samples.find(name);
    all.push_back(found == facts.samples.end() ? Samples() : found->second);
    std::ranges::sort(all.back());
  }
  return all;
}

double mean_magnitude(const Samples& samples) {
  double sum = 0;
  for (const double sample : samples) sum += std::abs(sample);
  return sum / static_cast<double>(samples.size());
}

DistanceMatrix distances_between(const std::vector<Samples>& runs) {
  DistanceMatrix distances(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (runs[i].empty() || runs[j].empty()) continue;
      distances.set(i, j, distance_between(runs[i], runs[j]));
    }
  }
  return distances;
}

}  // namespace

const FigureError* PointError::largest() const {
  const auto at = std::ranges::max_element(figures, {}, &FigureError::error);
  return at == figures.end() ? nullptr : &*at;
}

double distance_between(std::span<const double> a, std::span<const double> b) {
  SUNDER_CHECK(!a.empty() && !b.empty());
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

double noise_floor(std::string_view name, double mean_magnitude) {
  const auto unit =
      std::ranges::find_if(kUnitFloors, [&](const auto& one) { return name.ends_with(one.first); });
  SUNDER_CHECK(unit != std::end(kUnitFloors));
  return std::max(kRelativeFloor * mean_magnitude, unit->second);
}

RunDistances::RunDistances(std::span<const Facts> runs) {
  std::set<std::string> names;
  for (const Facts& facts : runs)
    for (const auto& [name, samples] : facts.samples) names.insert(name);
  for (const std::string& name : names) {
    const std::vector<Samples> samples = sorted_samples(runs, name);
    Figure figure{name, distances_between(samples), {}};
    for (const Samples& each : samples)
      figure.magnitudes.push_back(each.empty() ? -1 : mean_magnitude(each));
    figures_.push_back(std::move(figure));
  }
}

double RunDistances::scale(const Figure& figure, Group group) {
  double magnitude = 0;
  for (const std::size_t run : group) magnitude += figure.magnitudes[run];
  magnitude /= static_cast<double>(group.size());
  return std::max(spread(figure.distances, group), noise_floor(figure.name, magnitude));
}

std::vector<const RunDistances::Figure*> RunDistances::shared_figures(Group point,
                                                                      Group limit) const {
  std::vector<const Figure*> shared;
  for (const Figure& figure : figures_) {
    const auto has_samples = [&](std::size_t run) { return figure.magnitudes[run] >= 0; };
    if (std::ranges::all_of(point, has_samples) && std::ranges::all_of(limit, has_samples))
      shared.push_back(&figure);
  }
  return shared;
}

PointError RunDistances::compare(Group point, Group limit) const {
  std::vector<std::size_t> runs(point.begin(), point.end());
  runs.insert(runs.end(), limit.begin(), limit.end());
  PointError found;
  std::vector<DistanceMatrix> tested;
  std::vector<std::size_t> figure_of;  // indices of the figures that are tested
  DistanceMatrix all(runs.size());  // scaled by the spread of both groups, so that they are equal
  for (const Figure* figure : shared_figures(point, limit)) {
    FigureError error{figure->name, difference(figure->distances, point, limit),
                      scale(*figure, limit)};
    error.error = error.difference / error.spread;
    DistanceMatrix distances = figure->distances.part(runs);
    const double of_all = scale(*figure, runs);
    all.add(distances, 1 / of_all);
    if (distances.largest() > of_all) {  // or else all runs are within the noise floor
      figure_of.push_back(found.figures.size());
      tested.push_back(std::move(distances));
    }
    found.figures.push_back(std::move(error));
  }
  const auto count = static_cast<double>(found.figures.size());
  for (const FigureError& error : found.figures) found.error += error.error / count;
  if (tested.empty()) return found;
  tested.push_back(std::move(all));
  const std::vector<double> p = permutation_p(tested, point.size());
  found.p = std::ranges::min(p);
  for (std::size_t i = 0; i < figure_of.size(); ++i) found.figures[figure_of[i]].p = p[i];
  return found;
}

Interval RunDistances::interval(Group point, Group limit) const {
  const std::vector<const Figure*> figures = shared_figures(point, limit);
  if (figures.empty()) return {};
  Random random(2);
  const auto draw = [&](Group group) {
    std::vector<std::size_t> drawn;
    for (std::size_t i = 0; i < group.size(); ++i)
      drawn.push_back(group[random.below(static_cast<std::uint32_t>(group.size()))]);
    return drawn;
  };
  std::vector<double> errors;
  for (int i = 0; i < kResamples; ++i) {
    const std::vector<std::size_t> a = draw(point), b = draw(limit);
    double sum = 0;
    for (const Figure* figure : figures)
      sum += difference(figure->distances, a, b) / scale(*figure, b);
    errors.push_back(sum / static_cast<double>(figures.size()));
  }
  return {quantile(errors, kTail), quantile(errors, 1 - kTail)};
}

PointError point_error(std::span<const Facts> point, std::span<const Facts> limit) {
  std::vector<Facts> all(point.begin(), point.end());
  all.insert(all.end(), limit.begin(), limit.end());
  std::vector<std::size_t> runs(all.size());
  std::iota(runs.begin(), runs.end(), std::size_t{0});
  const RunDistances::Group order(runs);
  const RunDistances::Group a = order.first(point.size()), b = order.subspan(point.size());
  const RunDistances distances(all);
  PointError found = distances.compare(a, b);
  found.interval = distances.interval(a, b);
  return found;
}

}  // namespace sunder::scenes
