// A convex hull that grows point by point and knows its volume after each.
//
// Points added in the order of their place along a direction give the hull's volume on one side of
// every plane across that direction: the price of all parallel cuts from two passes.
#pragma once

#include <array>
#include <cstdint>
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
  /// A triangle; neighbour i is across the edge from vertex i to the next.
  struct Face {
    std::array<std::uint32_t, 3> vertices, neighbours;
  };
  /// An edge of the border of the faces seen, with the face beyond.
  struct Border {
    std::uint32_t from, to, beyond, face;
  };

  bool start(const Vec3& point);
  bool grow(const Vec3& point, double least_m3);
  double find_seen(const Vec3& point);
  bool find_border();
  void build_fan();
  std::uint32_t new_slot();
  void set_face(std::uint32_t slot, std::uint32_t a, std::uint32_t b, std::uint32_t c);

  Vec3 origin_ = Vec3::Zero();
  double size_ = 1;
  double volume_ = 0;
  std::uint64_t count_ = 0;  ///< Points added.
  std::vector<Vec3> points_;
  std::vector<Vec3> waiting_;  ///< Points that came before there were four that span a volume.
  std::vector<Face> faces_;    ///< Some are unused: see free_.
  /// Per face: six times the volume of the tetrahedron with p is x·p.x + y·p.y + z·p.z + d. Always
  /// whole blocks, padded with planes that nothing is outside of; so are unused faces.
  std::vector<double> x_, y_, z_, d_, gain_;
  std::vector<std::uint32_t> free_, seen_, border_at_;
  std::vector<Border> border_;
};

}  // namespace sunder::fracture
