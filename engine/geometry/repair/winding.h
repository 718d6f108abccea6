// Generalized winding numbers of triangles that may be open: the solid angle they cover, over 4·pi
// (Jacobson et al. 2013). Distant triangles are approximated by a dipole (Barill et al. 2018).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// A tree of triangles for the evaluation of winding numbers, thread-safe and deterministic.
class WindingField {
 public:
  explicit WindingField(std::vector<std::array<Vec3, 3>> triangles);

  /// Returns the winding number at a point, with an error of about 0.02: 1 inside a closed surface
  /// that faces outward, 0 outside, and values between near open parts.
  double at(const Vec3& point) const;
  /// Returns the number of triangles and dipoles that at() sums for a point.
  std::size_t work_at(const Vec3& point) const;

 private:
  struct Node {
    Vec3 center = Vec3::Zero();  ///< Area-weighted centroid of the triangles.
    Vec3 area = Vec3::Zero();    ///< Sum of the triangles' area vectors.
    double radius = 0;           ///< Radius of a ball around `center` that contains the triangles.
    std::uint32_t first = 0, count = 0;
    std::uint32_t next = 0;  ///< Index of the node after the subtree.
    bool leaf = false;
  };
  void build(std::uint32_t first, std::uint32_t count);
  template <class Far, class Near>
  void visit_nodes(const Vec3& point, const Far& far, const Near& near) const;
  void compute_dipole(Node& node) const;

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Node> nodes_;  ///< In depth-first order.
};

}  // namespace sunder
