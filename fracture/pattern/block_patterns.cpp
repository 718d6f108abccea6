// Patterns of blocks: cubes, and bricks in running bond.
#include <algorithm>
#include <cmath>
#include <map>

#include "fracture/pattern/pattern.h"

namespace sunder::fracture {
namespace {

/// Adds cells bounded by axis-aligned planes, and each plane once.
class Blocks {
 public:
  explicit Blocks(const Box& inner) : inner_(inner) {
    pattern_.planes = box_planes();
    first_ = add_outer_cells(pattern_, inner);
  }

  void add(const Box& block) {
    std::vector<PlaneId> sides;
    for (int axis = 0; axis < 3; ++axis) {
      sides.push_back(below(axis, block.max[axis]));
      sides.push_back(above(axis, block.min[axis]));
    }
    pattern_.cells.push_back({cut_cell(pattern_.planes, sides), 0, 0, false});
  }

  Pattern finished() {
    finish(pattern_);
    return std::move(pattern_);
  }

 private:
  PlaneId below(int axis, double at) {
    const auto high = first_ + 2 * static_cast<std::uint32_t>(axis);
    return at == inner_.max[axis] ? pattern_plane(high, false)
                                  : pattern_plane(plane_at(axis, at), false);
  }
  PlaneId above(int axis, double at) {
    const auto low = first_ + 2 * static_cast<std::uint32_t>(axis) + 1;
    return at == inner_.min[axis] ? pattern_plane(low, false)
                                  : pattern_plane(plane_at(axis, at), true);
  }
  std::uint32_t plane_at(int axis, double at) {
    const auto next = static_cast<std::uint32_t>(pattern_.planes.size());
    const auto [it, is_new] = planes_.emplace(std::pair{axis, at}, next);
    if (is_new) pattern_.planes.push_back({Vec3::Unit(axis), -at});
    return it->second;
  }

  Box inner_;
  Pattern pattern_;
  std::uint32_t first_ = 0;
  std::map<std::pair<int, double>, std::uint32_t> planes_;
};

/// Returns the joints of a course of 2 n + 1 blocks, the middle one centred at the origin.
std::vector<double> centred_joints(double size, int n) {
  std::vector<double> at;
  for (int i = -n; i <= n + 1; ++i) at.push_back((i - 0.5) * size);
  return at;
}

/// Returns the joints of a course with the ends of centred_joints(), moved by half a block.
std::vector<double> shifted_joints(double size, int n) {
  std::vector<double> at{(-n - 0.5) * size};
  for (int i = -n; i <= n; ++i) at.push_back(i * size);
  at.push_back((n + 0.5) * size);
  return at;
}

}  // namespace

Pattern grid_pattern(int count) {
  Blocks blocks({Vec3::Constant(-1), Vec3::Constant(1)});
  const auto at = [&](int i) { return i == count ? 1.0 : -1 + 2.0 * i / count; };
  for (int x = 0; x < count; ++x) {
    for (int y = 0; y < count; ++y) {
      for (int z = 0; z < count; ++z) {
        blocks.add({Vec3(at(x), at(y), at(z)), Vec3(at(x + 1), at(y + 1), at(z + 1))});
      }
    }
  }
  return blocks.finished();
}

Pattern brick_pattern(const Vec3& size) {
  // As many each way as cover the unit ball; fewer along all axes if those are too many.
  constexpr double kMostExtent = 0.9 * Pattern::kHalfExtent;
  int n[3];
  for (int most = 1 << 20;; most -= std::max(1, most / 8)) {
    double bricks = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double cover = std::ceil(1 / size[axis] - 0.5);
      const double fit = std::floor(kMostExtent / size[axis] - 0.5);
      n[axis] = static_cast<int>(std::clamp(std::min(cover, fit), 0.0, double(most)));
      bricks *= 2 * n[axis] + 1;
    }
    if (bricks <= kMostBricks || most <= 1) break;
  }
  const std::vector<double> y = centred_joints(size.y(), n[1]), z = centred_joints(size.z(), n[2]);
  const std::vector<double> even = centred_joints(size.x(), n[0]),
                            odd = shifted_joints(size.x(), n[0]);
  Blocks blocks({Vec3(even.front(), y.front(), z.front()), Vec3(even.back(), y.back(), z.back())});
  for (std::size_t j = 0; j + 1 < y.size(); ++j) {
    const bool is_even = j % 2 == static_cast<std::size_t>(n[1]) % 2;
    const std::vector<double>& x = is_even ? even : odd;
    for (std::size_t k = 0; k + 1 < z.size(); ++k) {
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        blocks.add({Vec3(x[i], y[j], z[k]), Vec3(x[i + 1], y[j + 1], z[k + 1])});
      }
    }
  }
  return blocks.finished();
}

}  // namespace sunder::fracture
