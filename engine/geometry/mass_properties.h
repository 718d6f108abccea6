// Volume, centre and inertia of solids of unit density.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// Of a solid of density 1: multiply volume and second moment by the density for mass and inertia.
struct MassProperties {
  double volume_m3 = 0;
  Vec3 centroid = Vec3::Zero();
  /// ∫ r rᵀ dV about the centroid (symmetric, m⁵); inertia = trace(S)·I − S.
  Mat3 second_moment = Mat3::Zero();

  Mat3 inertia() const { return second_moment.trace() * Mat3::Identity() - second_moment; }
};

/// The union of two solids that do not overlap (parallel-axis theorem).
MassProperties operator+(const MassProperties& a, const MassProperties& b);

}  // namespace sunder
