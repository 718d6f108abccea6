#include "scenes/trade/front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sunder::scenes {
namespace {

constexpr double kMinError = 1e-12;  // least error, for its logarithm

double log_error(const TradePoint& point) { return std::log(std::max(point.error, kMinError)); }

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const TradePoint> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, {}, [&](std::size_t i) { return std::pair(points[i].cost_ms, points[i].error); });
  std::vector<std::size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (!front.empty() && !(points[i].error < best)) continue;
    best = points[i].error;
    front.push_back(i);
  }
  return front;
}

double over_front(std::span<const TradePoint> points, std::size_t i) {
  const TradePoint& point = points[i];
  const std::vector<std::size_t> front = pareto_front(points);
  const auto after =
      std::ranges::find_if(front, [&](std::size_t k) { return points[k].error <= point.error; });
  const TradePoint& better = points[*after];  // exists: the last one has the least error
  if (after == front.begin()) return point.cost_ms / better.cost_ms;
  const TradePoint& worse = points[*std::prev(after)];
  const double share =
      (log_error(worse) - log_error(point)) / (log_error(worse) - log_error(better));
  return point.cost_ms / (worse.cost_ms * std::pow(better.cost_ms / worse.cost_ms, share));
}

}  // namespace sunder::scenes
