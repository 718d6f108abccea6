// Makes the rigid-body solver: projected Gauss-Seidel over coloured contacts, in soft substeps.
#pragma once

#include <memory>

#include "engine/model/physics.h"

namespace sunder::solver {

struct RigidOptions {
  Vec3 gravity_W = Vec3(0, -9.81, 0);
  bool sleeping = true;
  /// Number of colours, 0 to 64. Contacts of different colours are solved one after another;
  /// contacts that get no colour are solved in parallel by mass splitting. 64: coloured
  /// Gauss-Seidel; 0: mass splitting alone.
  int max_colors = 64;
  int sweeps = 1;  ///< Number of biased sweeps, and of relaxed sweeps, per substep.
  /// Sweeps are accelerated by conjugate gradients; has an effect from three sweeps a substep.
  bool accelerated = true;
  /// Maximum number of manifolds that a thread solves in SIMD lanes: 1, 4, 8 or 16, limited by the
  /// processor; 0: as many as the processor has. The results have the same bits for any number.
  int lanes = 0;
  /// Fraction of its static load that a contact of a new body starts with; 0: no static warm start.
  /// See static_warm_start.h.
  double static_warm_start = 1;
};

/// Returns the number of lanes that a solver uses if `lanes` are requested (see
/// RigidOptions::lanes).
int lanes_in_use(int lanes);

/// Returns a rigid-body solver. Results have the same bits for any number of threads, which
/// engine/base/parallel.h sets.
std::unique_ptr<Physics> make_rigid_physics(const RigidOptions& options);

}  // namespace sunder::solver
