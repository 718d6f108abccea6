// A grid over the obstacles near some particles: what does a small sphere hit on its way?
#pragma once

#include <array>
#include <bit>
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
  bool empty() const { return shapes_.empty(); }

  /// Indices of what may touch something within a box; some maybe twice.
  using Near = std::vector<std::uint32_t>;
  void find(const Vec3f& low, const Vec3f& high, Near& near) const;
  /// A sphere's way, straight, that takes the last duration_s of the step.
  struct Way {
    Vec3 from, to;
    double radius_m = 0;
    double duration_s = 0;
  };
  /// The first touch on a way with what is near all of it; obstacles move meanwhile, too.
  std::optional<Touch> sweep(const Way& way, const Near& near) const;

 private:
  /// A shape as far as most ways need it: all in one place, as memory is what takes time.
  struct Placed {
    std::uint32_t shape = 0;
    Vec3f min, max;  ///< Swept, in W.
    Vec3 center_W;   ///< Of its own box.
    Vec3f half_m;
    Mat3f rotation_BW;
    Vec3f velocity_W = Vec3f::Zero(), angular_velocity_W = Vec3f::Zero();  ///< Of its box.

    bool may_meet(const Way& way) const;
  };
  using Four = float __attribute__((vector_size(16)));
  static Four four(const Vec3f& v, float last = 0) { return Four{v.x(), v.y(), v.z(), last}; }
  /// A place in the hash: a box, and in the last lane of `min` the bits of an index in shapes_.
  struct Entry {
    Four min, max;

    std::uint32_t placed() const { return std::bit_cast<std::array<std::uint32_t, 4>>(min)[3]; }
  };
  static inline bool reaches(const Entry& entry, Four low, Four high);

  void place(std::size_t begin, std::size_t end, Which which);
  Placed placed(std::uint32_t shape) const;
  void sort_into_cells();
  void meet(const Placed& placed, const Way& way, std::optional<Touch>& first) const;

  Obstacles obstacles_;
  double dt_s_ = 0;
  std::vector<Mat3> rotations_WB_;    ///< Per body.
  std::vector<Box> boxes_;            ///< Per shape of the obstacles.
  std::vector<Placed> shapes_;        ///< Ascending.
  std::uint32_t levels_ = 0;          ///< A bit for each that holds something.
  std::uint32_t mask_ = 0;            ///< Buckets of the hash, less one.
  std::vector<std::uint32_t> first_;  ///< Per bucket, of entries_; one more at the end.
  std::vector<Entry> entries_;
};

}  // namespace sunder::solver
