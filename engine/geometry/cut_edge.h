// What every cut through an edge does alike: whoever shares the edge gets the same bits.
#pragma once

#include <cmath>
#include <tuple>

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

}  // namespace sunder
