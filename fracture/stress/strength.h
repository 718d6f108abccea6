// Strength of a bond between two materials.
#pragma once

#include <algorithm>
#include <limits>

#include "engine/model/material.h"

namespace sunder::fracture {

/// Stresses at which a bond breaks, in Pa; infinite where the material does not break by it.
struct Strength {
  double tensile_Pa, shear_Pa, compressive_Pa;
};

/// Returns the strength of a bond between two materials: that of the weaker, for each kind of
/// stress. A strength of 0 in a material means that it does not break by that stress.
inline Strength weaker_of(const Material& a, const Material& b) {
  const auto weaker = [](double x, double y) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    return std::min(x > 0 ? x : kNever, y > 0 ? y : kNever);
  };
  return {weaker(a.tensile_Pa, b.tensile_Pa), weaker(a.shear_Pa, b.shear_Pa),
          weaker(a.compressive_Pa, b.compressive_Pa)};
}

}  // namespace sunder::fracture
