#include "engine/geometry/mass_properties.h"

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

}  // namespace sunder
