// A bounding-box tree with fan-out eight, implicit in memory: leaves in Morton order, each node the
// union of eight nodes below it. Queries test eight boxes at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "engine/base/types.h"
#include "solver/base/wide.h"
#include "solver/rigid/body/slots.h"

namespace sunder::solver {

/// An axis-aligned box in floats, rounded outwards.
struct FloatBox {
  Vec3f min = Vec3f::Constant(1e30f);
  Vec3f max = Vec3f::Constant(-1e30f);

  bool overlaps(const FloatBox& o) const {
    return min.x() <= o.max.x() && o.min.x() <= max.x() && min.y() <= o.max.y() &&
           o.min.y() <= max.y() && min.z() <= o.max.z() && o.min.z() <= max.z();
  }
  bool contains(const FloatBox& o) const {
    return min.x() <= o.min.x() && o.max.x() <= max.x() && min.y() <= o.min.y() &&
           o.max.y() <= max.y() && min.z() <= o.min.z() && o.max.z() <= max.z();
  }
};

/// A ray, or the path of a ball, in floats with room for their rounding.
struct Ray {
  /// `direction` has unit length.
  Ray(const Vec3& from, const Vec3& direction, double reach, double radius)
      : from_W(from),
        direction_W(direction),
        start(from.cast<float>()),
        radius_m(static_cast<float>(radius) + 4e-7f * start.cwiseAbs().maxCoeff()),
        reach_m(reach) {
    for (int axis = 0; axis < 3; ++axis) {
      const double along = direction[axis];
      const double steep = std::max(std::abs(along), 1e-20);  // no division by zero
      inverse[axis] = static_cast<float>(std::copysign(1 / steep, along));
    }
    shorten(reach);
  }
  void shorten(double reach) {
    reach_m = std::min(reach_m, reach);
    most = static_cast<float>(reach_m) * kRoundUp;
  }

  static constexpr float kRoundUp = 1 + 1e-6f;
  Vec3 from_W, direction_W;
  Vec3f start, inverse;
  float radius_m;
  double reach_m;
  float most = 0;  ///< reach_m, rounded up.
};

class BoxTree {
 public:
  /// Sorts `items` and builds all levels.
  void build(const ByShape<FloatBox>& boxes, std::span<const ShapeSlot> items);
  /// Updates the boxes after items moved; the order of the leaves stays.
  void refit(const ByShape<FloatBox>& boxes);
  /// Calls hit(item) for each item whose box overlaps `query`.
  template <class Hit>
  void overlaps(const FloatBox& query, const Hit& hit) const;
  /// Calls hit(item) for each item whose box `ray` meets, near ones first by and large; hit() may
  /// shorten the ray.
  template <class Hit>
  void on_ray(const Ray& ray, const Hit& hit) const;
  std::size_t size() const { return items_.size(); }
  /// Items in leaf order; none where one was removed.
  std::span<const ShapeSlot> leaves() const { return items_; }
  /// Removes a leaf by making its box empty. The tree must not be refitted afterwards.
  void remove_leaf(std::uint32_t leaf);

  static auto fields(auto& self) { return std::tie(self.items_, self.levels_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct Chunk {
    Wide3 min, max;

    void set(std::size_t lane, const FloatBox& box);
    FloatBox get(std::size_t lane) const {
      return {{min.x[lane], min.y[lane], min.z[lane]}, {max.x[lane], max.y[lane], max.z[lane]}};
    }
    FloatBox bounds() const;
  };
  void fit_inner_levels();

  std::vector<ShapeSlot> items_;  ///< In leaf order.
  /// Level 0 has the leaves; the last level has one chunk.
  std::vector<std::vector<Chunk>> levels_;
};

template <class Hit>
void BoxTree::overlaps(const FloatBox& query, const Hit& hit) const {
  if (items_.empty()) return;
  struct Visit {
    std::uint32_t level, chunk;
  };
  Visit stack[128];
  std::uint32_t depth = 0;
  stack[depth++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
  while (depth > 0) {
    const Visit visit = stack[--depth];
    const Chunk& c = levels_[visit.level][visit.chunk];
    std::uint32_t inside =
        bits((c.min.x <= query.max.x()) & (c.max.x >= query.min.x()) & (c.min.y <= query.max.y()) &
             (c.max.y >= query.min.y()) & (c.min.z <= query.max.z()) & (c.max.z >= query.min.z()));
    for (; inside != 0; inside &= inside - 1) {
      const std::uint32_t child =
          visit.chunk * kLanes + static_cast<std::uint32_t>(__builtin_ctz(inside));
      if (visit.level == 0)
        hit(items_[child]);
      else
        stack[depth++] = {visit.level - 1, child};
    }
  }
}

template <class Hit>
void BoxTree::on_ray(const Ray& ray, const Hit& hit) const {
  if (items_.empty()) return;
  struct Visit {
    std::uint32_t level, chunk;
    float from;  ///< Distance at which the ray enters the box.
  };
  Visit stack[128];
  std::uint32_t depth = 0;
  stack[depth++] = {static_cast<std::uint32_t>(levels_.size()), 0, 0};
  while (depth > 0) {
    const Visit visit = stack[--depth];
    if (visit.from > ray.most) continue;
    if (visit.level == 0) {
      hit(items_[visit.chunk]);
      continue;
    }
    const std::uint32_t level = visit.level - 1;
    const Chunk& c = levels_[level][visit.chunk];
    Wide enter = splat(0.f), leave = splat(ray.most);
    const auto cut = [&](const Wide& min_m, const Wide& max_m, int axis) {
      const Wide first = (min_m - ray.radius_m - ray.start[axis]) * ray.inverse[axis];
      const Wide second = (max_m + ray.radius_m - ray.start[axis]) * ray.inverse[axis];
      enter = max(enter, min(first, second));
      leave = min(leave, max(first, second) * Ray::kRoundUp);
    };
    cut(c.min.x, c.max.x, 0);
    cut(c.min.y, c.max.y, 1);
    cut(c.min.z, c.max.z, 2);
    const std::uint32_t first = depth;
    // Empty boxes, whose min is above their max, would be met everywhere.
    for (std::uint32_t met = bits((enter <= leave) & (c.min.x <= c.max.x)); met != 0;
         met &= met - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(met));
      const Visit next{level, visit.chunk * kLanes + lane, enter[lane]};
      std::uint32_t place = depth++;  // the nearest last
      for (; place > first && stack[place - 1].from < next.from; --place)
        stack[place] = stack[place - 1];
      stack[place] = next;
    }
  }
}

}  // namespace sunder::solver
