// Even distribution of impulses over many contact points of two bodies, which a rigid-body solve
// leaves undetermined. Internal to solver.
#pragma once

#include <cstdint>
#include <span>

#include "engine/base/types.h"

namespace sunder::solver {

/// Normal impulse of a body on another at one contact point.
struct ContactPointImpulse {
  std::uint32_t shape = 0;    ///< Opaque to this module.
  Vec3 arm_W = Vec3::Zero();  ///< From the centre of mass of the loaded body.
  Vec3 direction_W = Vec3::UnitY();
  double impulse_Ns = 0;
};

/// Distributes the impulses over all points so that their sum and moment stay and the sum of their
/// squares is least. The impulses stay unchanged if one of them would be negative.
void distribute_evenly(std::span<ContactPointImpulse> points);

}  // namespace sunder::solver
