// Rotation of bodies over a step: it keeps the angular momentum that a body had and got in the
// step, whatever its final rotation. Read first: begin() and end().
#pragma once

#include <cstdint>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/body_row.h"
#include "solver/rigid/body/motion.h"
#include "solver/rigid/body/step_context.h"

namespace sunder::solver {

class Spins {
 public:
  void resize(std::uint32_t bodies);

  /// Sets the angular velocity (W) of a body to that after free rotation, in the frame of the body;
  /// or to the mean over the step if `midway`.
  void begin(const StepContext& step, BodySlot body, bool midway, Bodies& bodies);
  /// Angular momentum (root space) that is added to bodies at the end of the step, by row_of().
  Wide* pending() { return pending_.data(); }
  /// Finds the final rotation of a body, and returns the energy in J that it gains by the rotation:
  /// impulses are computed for the rotation at the start of the step.
  double end(const StepContext& step, BodySlot body, const BodyRow& row, const Mat3f& root_W,
             const Bodies& bodies);
  /// Changes the final state so that no energy is gained: by a slightly different rotation, or else
  /// by keeping the energy instead of the angular momentum.
  void keep_energy(BodySlot body, const BodyRow& row, const Mat3f& root_W, const Bodies& bodies);
  const RotationState& state(BodySlot body) const { return spin_[body].state; }
  /// True if the final rotation gains energy.
  bool gains_energy(BodySlot body) const { return spin_[body].gain_J > 0; }

 private:
  struct Spin {
    Vec3 momentum_W;
    RotationState state;  ///< Free rotation; after end(), the final state.
    double gain_J = 0;
    bool gyroscopic = false;
  };

  ByBody<Spin> spin_;
  std::vector<Wide> pending_;
};

}  // namespace sunder::solver
