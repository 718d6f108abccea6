// Cuts through edges, with the same bits for all faces and solids that share an edge.
#pragma once

#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Returns true if `a` comes before `b` in lexicographic order. Cuts of an edge are computed from
/// the end that comes first, whatever the direction of the edge.
inline bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

/// Returns the shading normal at `t` (0 to 1) from `a` to `b`; the face's normal if they cancel.
inline Vec3f interpolate_normal(const Vec3f& a, const Vec3f& b, double t, const Vec3& face_normal) {
  if (a == b) return a;
  const Vec3f sum = a + static_cast<float>(t) * (b - a);
  const float square = sum.squaredNorm();
  return square > 1e-12f ? Vec3f(sum / std::sqrt(square)) : Vec3f(face_normal.cast<float>());
}

/// The intersection of an edge with the cutting plane.
struct EdgeCrossing {
  std::uint32_t outside;  ///< The outside vertex of the edge.
  std::uint32_t vertex;   ///< The new vertex, in the result.
  std::uint32_t next;     ///< Next crossing in the list of the same inside vertex.
  double t;  ///< Position along the edge, 0 at its lexicographically first end, 1 at the other.
  bool inside_first;  ///< True if the inside vertex is the lexicographically first end.
};

/// The crossings of one cut, numbered in order of addition and found by the ends of their edges.
class EdgeCrossings {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Removes all crossings, for a cut of a solid with `vertices` vertices.
  void restart(std::size_t vertices) {
    first_.assign(vertices, kNone);
    all_.clear();
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(all_.size()); }
  const EdgeCrossing& operator[](std::uint32_t number) const { return all_[number]; }
  /// Returns the number of an edge's crossing; kNone if it has none.
  std::uint32_t find(std::uint32_t inside, std::uint32_t outside) const {
    std::uint32_t number = first_[inside];
    while (number != kNone && all_[number].outside != outside) number = all_[number].next;
    return number;
  }
  /// Adds the crossing of an edge that has none, and returns its number.
  std::uint32_t add(std::uint32_t inside, std::uint32_t outside, std::uint32_t vertex, double t,
                    bool inside_first) {
    all_.push_back({outside, vertex, first_[inside], t, inside_first});
    return first_[inside] = size() - 1;
  }

 private:
  std::vector<std::uint32_t> first_;  ///< Head of the list of each inside vertex.
  std::vector<EdgeCrossing> all_;
};

}  // namespace sunder
