// Fields on a box of cubic cells and their faces, with a border of zeros for stencils at the edge.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/base/types.h"

namespace sunder::solver {

using Vec3i = Eigen::Vector3i;
using Field = std::vector<float>;

/// Indexing of cells and faces. Cells (i, j, k) run from 1 to counts; face (i, j, k) of an axis is
/// the lower face of that cell, so faces run one further along their axis.
struct Lattice {
  static constexpr int kMostCells = 1024;  ///< Along an axis, of a saved state.
  Vec3i counts = Vec3i::Zero();

  std::ptrdiff_t stride(int axis) const {
    const std::ptrdiff_t row = counts.x() + 3;
    return axis == 0 ? 1 : axis == 1 ? row : row * (counts.y() + 3);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i + j * stride(1) + k * stride(2));
  }
  std::size_t size() const {
    return static_cast<std::size_t>(stride(2)) * static_cast<std::size_t>(counts.z() + 3);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const {
    return counts.minCoeff() >= 0 && counts.maxCoeff() <= kMostCells ? nullptr : "counts";
  }
  std::size_t cells() const { return static_cast<std::size_t>(counts.prod()); }
  /// Returns the number of cell layers per parallel chunk; depends on the lattice alone.
  std::size_t layers_a_chunk() const {
    const auto layer = static_cast<std::size_t>(counts.x() * counts.y());
    return std::max<std::size_t>(1, (1 << 13) / layer);
  }
};

/// Returns the greatest magnitude in a row, by lanes: the compiler may not reorder comparisons.
inline float largest_in(const float* x, int count) {
  constexpr int kLanes = 8;
  float lanes[kLanes] = {};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (int l = 0; l < kLanes; ++l) {
      const float size = std::abs(x[i + l]);
      lanes[l] = lanes[l] > size ? lanes[l] : size;
    }
  }
  for (; i < count; ++i) lanes[0] = std::max(lanes[0], std::abs(x[i]));
  return *std::max_element(lanes, lanes + kLanes);
}

}  // namespace sunder::solver
