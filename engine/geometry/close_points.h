// Pairs of points that are close to each other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Calls `visit(a, b)` for each pair of points at most `distance_m` apart, given as indices. Points
/// are compared along an axis that is oblique to those of common meshes, on which few are close.
template <class Visit>
void each_close_pair(std::span<const Vec3> points, double distance_m, const Visit& visit) {
  const Vec3 axis = Vec3(0.3129, 0.5411, 0.7806).normalized();
  std::vector<std::pair<double, std::uint32_t>> along;
  along.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) along.emplace_back(axis.dot(points[i]), i);
  std::sort(along.begin(), along.end());
  double reach = 0;
  if (!along.empty()) reach = std::max(std::abs(along.front().first), std::abs(along.back().first));
  const double most = distance_m + 1e-15 * reach;  // along the axis, with rounding errors
  for (std::size_t i = 0; i < along.size(); ++i) {
    for (std::size_t j = i + 1; j < along.size() && along[j].first - along[i].first <= most; ++j) {
      const std::uint32_t a = along[i].second, b = along[j].second;
      if ((points[a] - points[b]).squaredNorm() <= distance_m * distance_m) visit(a, b);
    }
  }
}

}  // namespace sunder
