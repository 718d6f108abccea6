// A grid over the obstacles near some particles, for sweeps of small spheres.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/obstacle_sweep.h"

namespace sunder::solver {

/// A hierarchical hash grid, built anew each step and queried from any thread. Obstacles lie in
/// cells of about their own size, so that neither a few large nor a few distant ones are slow.
class ObstacleGrid {
 public:
  enum class Which { kAll, kMoving };

  /// Builds the grid of obstacles that touch `region` within the last dt_s; they must outlive
  /// queries.
  void build(const Obstacles& obstacles, double dt_s, const Box& region, Which which);
  bool empty() const { return placed_.shapes.empty(); }

  /// Candidate shapes for some paths, and the box from `low` to `high` for which they are complete.
  struct Near {
    std::vector<std::uint32_t> shapes;  ///< Indices of placed shapes; may contain duplicates.
    Vec3f low = Vec3f::Constant(1), high = Vec3f::Zero();
  };
  /// Finds the shapes near some paths, which should be close together. Reuses `near` if sufficient.
  void find(std::span<const SpherePath> paths, Near& near) const;
  /// Finds the first contact of each of up to eight paths with the shapes of `near`.
  void sweep(std::span<const SpherePath> paths, const Near& near,
             std::span<std::optional<SphereContact>> touches) const {
    sweep_spheres(placed_, near.shapes, paths, touches);
  }

 private:
  using Four = float __attribute__((vector_size(16)));
  static Four four(const Vec3f& v, float last = 0) { return Four{v.x(), v.y(), v.z(), last}; }
  /// An entry of the hash table: the box of a placed shape; the last lane of `min` holds its index.
  struct Entry {
    Four min, max;

    std::uint32_t placed() const { return std::bit_cast<std::array<std::uint32_t, 4>>(min)[3]; }
  };
  static inline bool overlaps_box(const Entry& entry, Four low, Four high);

  void find(const Vec3f& low, const Vec3f& high, std::vector<std::uint32_t>& shapes) const;
  void compute_boxes(std::size_t begin, std::size_t end, Which which);
  PlacedObstacle placed(std::uint32_t shape) const;
  void sort_into_cells();

  PlacedObstacles placed_;
  double dt_s_ = 0;
  std::vector<Box> boxes_;              ///< Swept box of each shape of the obstacles.
  std::vector<std::uint32_t> reached_;  ///< Shapes that touch the region.
  std::uint32_t levels_ = 0;            ///< Bit mask of the levels with entries.
  std::uint32_t mask_ = 0;              ///< Number of hash buckets - 1.
  std::vector<std::uint32_t> first_;    ///< First entry of each bucket, and the end of the last.
  std::vector<Entry> entries_;
};

}  // namespace sunder::solver
