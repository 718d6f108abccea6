// Which points of a study nobody should choose, as another is cheaper and better.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sunder::bench {

/// One point of a study's grid on one scene.
struct TradePoint {
  std::string name;
  bool is_preset = false;
  double cost_ms = 0;
  double error = 0;
};

/// The points that no other beats, both in cost and in error, cheapest first; of equal ones, the
/// first.
std::vector<std::size_t> pareto_front(std::span<const TradePoint> points);

/// The cost of point i over that of the front at equal error, by straight lines through its points
/// in logarithms of both; 1 on the front. A point worse than the cheapest is held against that. Of
/// costs above 0.
double over_front(std::span<const TradePoint> points, std::size_t i);

}  // namespace sunder::bench
