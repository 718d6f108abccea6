// A convex hull that grows point by point and knows its volume after each.
//
// Points added in the order of their place along a direction give the hull's volume on one side of
// every plane across that direction: the price of all parallel cuts from two passes.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/types.h"

namespace sunder::fracture {

/// Volumes are those of the points' hull within about 1e-5; nothing else is promised of its faces.
class SweepHull {
 public:
  /// Forgets all points; those to come span about `size_m`, and lie around `origin`.
  void restart(const Vec3& origin, double size_m);
  /// Includes a point if it adds more than a volume; tells whether.
  bool add(const Vec3& point, double least_m3 = 0);
  double volume_m3() const { return volume_; }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  bool start(const Vec3& point);
  bool grow(const Vec3& point, double least_m3);
  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void drop_face(std::size_t face);
  void toggle(std::uint32_t from, std::uint32_t to);

  Vec3 origin_ = Vec3::Zero();
  double size_ = 1;
  double volume_ = 0;
  std::uint64_t count_ = 0;  ///< Points added.
  std::vector<Vec3> points_;
  std::vector<Vec3> waiting_;  ///< Points that came before there were four that span a volume.
  /// Faces: six times the volume of the tetrahedron with p is x·p.x + y·p.y + z·p.z + d.
  std::vector<double> x_, y_, z_, d_, gain_;
  std::vector<std::array<std::uint32_t, 3>> faces_;
  std::vector<std::uint32_t> seen_;
  std::vector<Edge> horizon_;
};

}  // namespace sunder::fracture
