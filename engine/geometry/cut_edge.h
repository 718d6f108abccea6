// What every cut through an edge does alike: whoever shares the edge gets the same bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Edges are cut from the end that comes first in this order, whichever way they run.
inline bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

/// The shading normal at `t` between two corners of a face; the face's own where they cancel.
inline Vec3f blend(const Vec3f& a, const Vec3f& b, double t, const Vec3& face_normal) {
  if (a == b) return a;
  const Vec3f sum = a + static_cast<float>(t) * (b - a);
  const float square = sum.squaredNorm();
  return square > 1e-12f ? Vec3f(sum / std::sqrt(square)) : Vec3f(face_normal.cast<float>());
}

/// Where an edge is cut.
struct EdgeCrossing {
  std::uint32_t outside;  ///< The edge's vertex that is cut off.
  std::uint32_t vertex;   ///< Where it is cut, in the result.
  std::uint32_t next;     ///< Of the same inside vertex.
  double t;               ///< Place along the edge, from its lexicographically first end.
  bool inside_first;      ///< Which end that is.
};

/// The crossings of one cut, numbered as they are added and found again by their edges' ends.
class EdgeCrossings {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Forgets all; the next cut has so many vertices.
  void restart(std::size_t vertices) {
    first_.assign(vertices, kNone);
    all_.clear();
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(all_.size()); }
  const EdgeCrossing& operator[](std::uint32_t number) const { return all_[number]; }
  /// The number of the edge's crossing; kNone if it has none yet.
  std::uint32_t find(std::uint32_t inside, std::uint32_t outside) const {
    std::uint32_t number = first_[inside];
    while (number != kNone && all_[number].outside != outside) number = all_[number].next;
    return number;
  }
  /// Adds that of an edge which has none, and returns its number.
  std::uint32_t add(std::uint32_t inside, std::uint32_t outside, std::uint32_t vertex, double t,
                    bool inside_first) {
    all_.push_back({outside, vertex, first_[inside], t, inside_first});
    return first_[inside] = size() - 1;
  }

 private:
  std::vector<std::uint32_t> first_;  ///< Per inside vertex, heads of lists.
  std::vector<EdgeCrossing> all_;
};

}  // namespace sunder
