// Our own rigid bodies behind the Physics seam: coloured PGS with soft substeps.
#pragma once

#include <memory>

#include "engine/model/physics.h"

namespace sunder::solver {

struct RigidOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  bool sleeping = true;
  /// Colours that contacts are solved in, one after another; those that find none are solved side
  /// by side with their bodies split. 64: coloured Gauss-Seidel; 0: mass splitting alone.
  int max_colors = 64;
  int sweeps = 1;  ///< Of either kind in a substep.
  /// Sweeps go by conjugate gradients, which tell from three a substep on.
  bool accelerated = true;
  /// Manifolds solved side by side by a thread: 1, 4, 8 or 16, or fewer if the processor has not
  /// so many; 0: the most it has. The same bits for any.
  int lanes = 0;
  /// Part of its load that a contact of new bodies is given: see static_warm_start.h. 0: it starts
  /// cold.
  double static_warm_start = 1;
};

/// The lanes that a solver works with if it is asked for so many.
int lanes_in_use(int lanes);

/// The same bits for any number of threads (engine/base/parallel.h sets it).
std::unique_ptr<Physics> make_rigid_physics(const RigidOptions& options);

}  // namespace sunder::solver
