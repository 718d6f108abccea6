// A grid over the obstacles near some particles: what does a small sphere hit on its way?
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/particles.h"

namespace sunder::solver {

/// Where a sphere meets an obstacle.
struct ObstacleTouch {
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

  /// A sphere's way, straight, that takes the last duration_s of the step.
  struct Way {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    double radius_m = 0;
    double duration_s = 0;
  };
  /// What may lie in some ways, and how far around them that was looked for.
  struct Near {
    std::vector<std::uint32_t> shapes;  ///< Indices; some maybe twice.
    Vec3f low = Vec3f::Constant(1), high = Vec3f::Zero();
  };
  /// Keeps what `near` holds where that is enough. Best for ways that lie close together.
  void find(std::span<const Way> ways, Near& near) const;
  /// The first touch of each of up to eight ways with what is near; obstacles move meanwhile, too.
  void sweep(std::span<const Way> ways, const Near& near,
             std::span<std::optional<ObstacleTouch>> touches) const;

 private:
  /// A shape as far as most ways need it: all in one place, as memory is what takes time.
  struct Placed {
    std::uint32_t shape = 0;
    std::span<const ConvexPolyhedron::Face> faces;  ///< None of a ball.
    Vec3f min, max;                                 ///< Swept, in W.
    Vec3f center_W;                                 ///< Of its own box.
    Vec3f half_m;
    Mat3f rotation_BW;
    Vec3f velocity_W = Vec3f::Zero(), angular_velocity_W = Vec3f::Zero();  ///< Of its box.
  };
  struct WideWays;
  struct SeenWays;
  using Four = float __attribute__((vector_size(16)));
  static Four four(const Vec3f& v, float last = 0) { return Four{v.x(), v.y(), v.z(), last}; }
  /// A place in the hash: a box, and in the last lane of `min` the bits of an index in shapes_.
  struct Entry {
    Four min, max;

    std::uint32_t placed() const { return std::bit_cast<std::array<std::uint32_t, 4>>(min)[3]; }
  };
  static inline bool reaches(const Entry& entry, Four low, Four high);

  void find(const Vec3f& low, const Vec3f& high, std::vector<std::uint32_t>& shapes) const;
  void place(std::size_t begin, std::size_t end, Which which);
  Placed placed(std::uint32_t shape) const;
  void sort_into_cells();
  void fetch(const Placed& placed) const;
  void meet(const Placed& placed, const WideWays& wide, const SeenWays& seen,
            std::span<const Way> ways, std::span<std::optional<ObstacleTouch>> touches) const;

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
