// Volume, first and second moment summed over the triangles of a closed surface.
#pragma once

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// Sums tetrahedra between a point of the solid and its surface's triangles. Taken near the solid,
/// the point keeps the sums from cancelling.
class Moments {
 public:
  explicit Moments(const Vec3& origin) : origin_(origin) {}

  /// A triangle counter-clockwise seen from outside, relative to the origin.
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double det = a.dot(b.cross(c));
    const Vec3 sum = a + b + c;
    volume6_ += det;
    first24_ += det * sum;
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col <= row; ++col) {
        second120_(row, col) +=
            det * (a[row] * a[col] + b[row] * b[col] + c[row] * c[col] + sum[row] * sum[col]);
      }
    }
  }

  /// What the triangles given so far enclose; meaningful once they close.
  MassProperties sum() const;

 private:
  Vec3 origin_;
  double volume6_ = 0;
  Vec3 first24_ = Vec3::Zero();
  Mat3 second120_ = Mat3::Zero();  ///< Lower triangle.
};

}  // namespace sunder
