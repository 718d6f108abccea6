// Volume, first and second moments of a solid, from the triangles of its surface.
#pragma once

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// Sums moments of the tetrahedra between an origin and the triangles of a surface. An origin near
/// the solid avoids cancellation.
class Moments {
 public:
  explicit Moments(const Vec3& origin) : origin_(origin) {}

  /// Adds a triangle, counter-clockwise seen from outside, with corners relative to the origin.
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

  /// Returns the mass properties of the enclosed solid; the triangles must form a closed surface.
  MassProperties sum() const;

 private:
  Vec3 origin_;
  double volume6_ = 0;             ///< 6 times the volume.
  Vec3 first24_ = Vec3::Zero();    ///< 24 times the first moment.
  Mat3 second120_ = Mat3::Zero();  ///< 120 times the second moment; lower triangle only.
};

}  // namespace sunder
