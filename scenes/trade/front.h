// Pareto front of a study's points: those that no other point beats in both cost and error.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sunder::scenes {

/// A point of the study's grid on one scene.
struct TradePoint {
  std::string name;
  bool is_preset = false;
  double cost_ms = 0;
  double error = 0;
};

/// Returns the points that no other beats in both cost and error, cheapest first; of equals, the
/// first.
std::vector<std::size_t> pareto_front(std::span<const TradePoint> points);

/// Returns the cost of point i divided by the cost of the front at equal error; 1 on the front. The
/// front is interpolated linearly in the logarithms of cost and error. A point with a larger error
/// than the cheapest is compared with the cheapest. Costs must be above 0.
double over_front(std::span<const TradePoint> points, std::size_t i);

}  // namespace sunder::scenes
