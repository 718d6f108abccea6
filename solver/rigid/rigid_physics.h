// Our own rigid bodies behind the Physics seam: coloured PGS with soft substeps.
#pragma once

#include <memory>

#include "engine/world/physics.h"

namespace sunder::solver {

struct RigidOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  bool sleeping = true;
};

/// The same bits for any number of threads (engine/base/parallel.h sets it).
std::unique_ptr<Physics> make_rigid_physics(const RigidOptions& options);

}  // namespace sunder::solver
