// A convex hull that is built point by point, with its volume after each point.
//
// Points added in order along a direction give the hull volume on one side of every plane across
// that direction, so two passes evaluate all parallel cuts.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/types.h"

namespace sunder::fracture {

/// Incremental convex hull. Its volume has a relative error of about 1e-5; faces are not exposed.
class SweepHull {
 public:
  /// Removes all points; the next points lie around `origin` within about `size_m`.
  void restart(const Vec3& origin, double size_m);
  /// Adds a point if that increases the volume by more than `least_m3`; returns true if it was
  /// added, or is kept until four points span a volume.
  bool add(const Vec3& point, double least_m3 = 0);
  double volume_m3() const { return volume_; }

 private:
  /// A triangle; neighbour i is across the edge from vertex i to vertex i + 1.
  struct Face {
    std::array<std::uint32_t, 3> vertices, neighbours;
  };
  /// An edge of the boundary of the visible faces, with the face beyond it.
  struct Border {
    std::uint32_t from, to, beyond, face;
  };

  bool start(const Vec3& point);
  bool grow(const Vec3& point, double least_m3);
  double find_visible(const Vec3& point);
  bool find_border();
  void build_fan();
  std::uint32_t new_slot();
  void set_face(std::uint32_t slot, std::uint32_t a, std::uint32_t b, std::uint32_t c);

  Vec3 origin_ = Vec3::Zero();
  double size_ = 1;
  double volume_ = 0;
  std::uint64_t count_ = 0;  ///< Number of points passed to add().
  std::vector<Vec3> points_;
  std::vector<Vec3> pending_;  ///< Points kept until four points span a volume.
  std::vector<Face> faces_;    ///< Includes unused faces; see free_.
  /// Per face: x·p.x + y·p.y + z·p.z + d is six times the volume of its tetrahedron with p. Padded
  /// to whole blocks with planes that have no point outside, as are unused faces.
  std::vector<double> x_, y_, z_, d_, gain_;
  std::vector<std::uint32_t> free_, visible_, border_at_;
  std::vector<Border> border_;
};

}  // namespace sunder::fracture
