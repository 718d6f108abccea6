#include "engine/geometry/moments.h"

namespace sunder {

MassProperties operator+(const MassProperties& a, const MassProperties& b) {
  MassProperties sum;
  sum.volume_m3 = a.volume_m3 + b.volume_m3;
  if (sum.volume_m3 == 0) return sum;
  const double share = b.volume_m3 / sum.volume_m3;
  const Vec3 apart = b.centroid - a.centroid;
  sum.centroid = a.centroid + share * apart;
  sum.second_moment =
      a.second_moment + b.second_moment + (a.volume_m3 * share) * (apart * apart.transpose());
  return sum;
}

MassProperties Moments::sum() const {
  MassProperties solid;
  solid.volume_m3 = volume6_ / 6;
  const Vec3 offset = volume6_ > 0 ? Vec3(first24_ / (4 * volume6_)) : Vec3::Zero();
  solid.centroid = origin_ + offset;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col <= row; ++col) {
      const double about_centroid =
          second120_(row, col) / 120 - solid.volume_m3 * offset[row] * offset[col];
      solid.second_moment(row, col) = solid.second_moment(col, row) = about_centroid;
    }
  }
  return solid;
}

}  // namespace sunder
