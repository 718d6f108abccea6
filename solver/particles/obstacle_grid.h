// A grid over the obstacles near some particles: what does a small sphere hit on its way?
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

/// Built anew each step, queried from any thread. Obstacles lie in cells of their own size, found
/// by a hash: neither a few that are large nor a few that are far away make it slow.
class ObstacleGrid {
 public:
  enum class Which { kAll, kMoving };
  /// What moves slower than this lies still to chips.
  static constexpr double kCreep_m_s = 0.05;

  /// Keeps what touches `region` on its way through the last dt_s; `obstacles` must outlive the
  /// queries.
  void build(const Obstacles& obstacles, double dt_s, const Box& region, Which which);
  bool empty() const { return placed_.shapes.empty(); }

  /// What may lie in some ways, and how far around them that was looked for.
  struct Near {
    std::vector<std::uint32_t> shapes;  ///< Indices; some maybe twice.
    Vec3f low = Vec3f::Constant(1), high = Vec3f::Zero();
  };
  /// Keeps what `near` holds where that is enough. Best for ways that lie close together.
  void find(std::span<const SphereWay> ways, Near& near) const;
  /// The first touch of each of up to eight ways with what is near.
  void sweep(std::span<const SphereWay> ways, const Near& near,
             std::span<std::optional<ObstacleTouch>> touches) const {
    sweep_spheres(placed_, near.shapes, ways, touches);
  }

 private:
  using Four = float __attribute__((vector_size(16)));
  static Four four(const Vec3f& v, float last = 0) { return Four{v.x(), v.y(), v.z(), last}; }
  /// A place in the hash: a box, and in the last lane of `min` the bits of an index among those
  /// placed.
  struct Entry {
    Four min, max;

    std::uint32_t placed() const { return std::bit_cast<std::array<std::uint32_t, 4>>(min)[3]; }
  };
  static inline bool reaches(const Entry& entry, Four low, Four high);

  void find(const Vec3f& low, const Vec3f& high, std::vector<std::uint32_t>& shapes) const;
  void place(std::size_t begin, std::size_t end, Which which);
  PlacedObstacle placed(std::uint32_t shape) const;
  void sort_into_cells();

  PlacedObstacles placed_;
  double dt_s_ = 0;
  std::vector<Box> boxes_;              ///< Per shape of the obstacles.
  std::vector<std::uint32_t> reached_;  ///< Shapes that touch the region.
  std::uint32_t levels_ = 0;            ///< A bit for each that holds something.
  std::uint32_t mask_ = 0;              ///< Buckets of the hash, less one.
  std::vector<std::uint32_t> first_;    ///< Per bucket, of entries_; one more at the end.
  std::vector<Entry> entries_;
};

}  // namespace sunder::solver
