// A uniform grid over the obstacles near some particles: what does a small sphere hit on its way?
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/world/particles.h"

namespace sunder::solver {

/// Where a sphere meets an obstacle.
struct Touch {
  double time = 1;     ///< Part of the way; 0 if it started inside.
  double depth_m = 0;  ///< At the end of the way, along the normal; > 0 if it started inside.
  Vec3 normal_W = Vec3::UnitY();   ///< Unit, out of the obstacle.
  Vec3 velocity_W = Vec3::Zero();  ///< Of the obstacle's surface there.
  std::uint32_t body = 0;          ///< Index in Obstacles::bodies.
};

/// Built anew each step, queried from any thread.
class ObstacleGrid {
 public:
  enum class Which { kAll, kMoving };

  /// Keeps what touches `region` on its way through the last dt_s; `obstacles` must outlive the
  /// queries.
  void build(const Obstacles& obstacles, double dt_s, const Box& region, Which which);
  bool empty() const { return shapes_.empty(); }
  /// A sphere's way, straight, that takes the last duration_s of the step.
  struct Way {
    Vec3 from, to;
    double radius_m = 0;
    double duration_s = 0;
  };
  /// The first touch on a way; obstacles move meanwhile, too.
  std::optional<Touch> sweep(const Way& way) const;

 private:
  struct Placed {
    std::uint32_t shape = 0;
    Vec3f min, max;  ///< Swept, in W.

    bool reaches(const Vec3f& low, const Vec3f& high) const {
      return min.x() <= high.x() && low.x() <= max.x() && min.y() <= high.y() &&
             low.y() <= max.y() && min.z() <= high.z() && low.z() <= max.z();
    }
  };
  using Cell = Eigen::Vector3i;

  void place(std::size_t begin, std::size_t end, Which which);
  void choose_cells(const Box& region);
  void sort_into_cells();
  Cell cell_of(const Vec3f& point_W) const {
    const Vec3f scaled = (point_W - origin_W_).cwiseProduct(cells_per_m_);
    return scaled.cwiseMax(0.0f).cwiseMin(last_cell_).cast<int>();
  }
  void meet(const Placed& placed, const Way& way, std::optional<Touch>& first) const;

  Obstacles obstacles_;
  double dt_s_ = 0;
  std::vector<Mat3> rotations_WB_;  ///< Per body.
  std::vector<Box> boxes_;          ///< Per shape of the obstacles.
  std::vector<Placed> shapes_;      ///< Ascending.
  Vec3f origin_W_ = Vec3f::Zero();
  Vec3f cells_per_m_ = Vec3f::Ones();
  Cell counts_ = Cell::Ones();
  Vec3f last_cell_ = Vec3f::Zero();
  std::vector<std::uint32_t> first_;    ///< Per cell, of entries_; one more at the end.
  std::vector<std::uint32_t> entries_;  ///< Indices in shapes_.
};

}  // namespace sunder::solver
