// The generalized winding number of triangles that need not close: how much of the view from a
// point they enclose (Jacobson et al. 2013), fast by far triangles acting as one dipole (Barill et
// al. 2018).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Built once, asked often, from any thread; the same bits each time.
class WindingField {
 public:
  explicit WindingField(std::vector<std::array<Vec3, 3>> triangles);

  /// 1 inside a closed surface that faces outward, 0 outside, between where it is open; within
  /// about 0.02.
  double at(const Vec3& point) const;
  /// How many triangles and dipoles an answer there adds up.
  std::size_t work_at(const Vec3& point) const;

 private:
  struct Node {
    Vec3 center = Vec3::Zero();  ///< Of the area below it.
    Vec3 area = Vec3::Zero();    ///< Sum of the triangles' areas times their normals.
    double radius = 0;           ///< Reaches every triangle below it from the center.
    std::uint32_t first = 0, count = 0;
    std::uint32_t next = 0;  ///< The node after the subtree.
    bool leaf = false;
  };
  void build(std::uint32_t first, std::uint32_t count);
  template <class Far, class Near>
  void walk(const Vec3& point, const Far& far, const Near& near) const;
  void summarise(Node& node) const;

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Node> nodes_;  ///< Depth first.
};

}  // namespace sunder
