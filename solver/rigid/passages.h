// Bodies that passed through others within a step, as a body does that bounces off one wall into
// another, and that are put back to where they touched.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/broad_phase.h"
#include "solver/rigid/joint/joint.h"

namespace sunder::solver {

/// Puts back what the contacts of a step did not stop: shapes that were apart from another, and
/// whose centre went into it.
/// Both bodies return to where they were before they met, with their momentum, their angular
/// momentum and no more energy, and the next step finds their contact. For the rest of the step
/// they go on together, as their centre of mass did, or with a kinematic body that they met; beside
/// what does not move they stay, without what gravity added to their velocity. Bodies whose contact
/// did nothing in a whole step lose the speed at which they went into each other.
class Passages {
 public:
  /// Keeps the poses at the start of a step.
  void begin(const Bodies& bodies);
  struct PutBack {
    std::size_t bodies = 0;
    Vec3 impulse_Ns = Vec3::Zero();  ///< Impulse of gravity taken back, and of what does not move.
  };
  /// Puts back all bodies that passed through others since begin(), with all that joints hold to
  /// them.
  PutBack put_back(const StepContext& step, const BroadPhase& broad_phase, const Shapes& shapes,
                   const Joints& joints, Bodies& bodies) const;

 private:
  ByBody<Vec3> position_;
  ByBody<Quat> rotation_;
};

}  // namespace sunder::solver
