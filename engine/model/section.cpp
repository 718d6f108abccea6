#include "engine/model/section.h"

#include <cmath>

#include "engine/base/roots.h"

namespace sunder {

SectionLoad relative_load(const SectionStrength& strength, const Wrench& wrench_R) {
  const Vec3 force = strength.axes_R.transpose() * wrench_R.force_N;
  const Vec3 moment = strength.axes_R.transpose() * wrench_R.moment_Nm;
  const Vec3 turning = moment.cwiseQuotient(strength.moment_Nm);
  const double shear = hypotenuse(force.y(), force.z()) / strength.shear_N;
  return {force.x() / strength.axial_N, std::sqrt(turning.squaredNorm() + shear * shear)};
}

double utilisation(const SectionStrength& strength, const Wrench& wrench_R) {
  // The load factor s satisfies s·m + s²·n² = 1; this is 1/s.
  const SectionLoad load = relative_load(strength, wrench_R);
  return 0.5 * (load.across + hypotenuse(load.across, 2 * load.axial));
}

}  // namespace sunder
