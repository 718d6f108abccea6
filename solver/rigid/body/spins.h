// How the bodies of a step turn: with the angular momentum that they had and got in it, whatever
// way they come to lie. Read first: begin() and end().
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

  /// Gives a body the angular velocity (W) that free rotation leaves it with, as the body sees it;
  /// midway of the step, if asked.
  void begin(const StepContext& step, BodySlot body, bool midway, Bodies& bodies);
  /// Angular momentum (root space) that rows get when the step ends, by row_of().
  Wide* owed() { return owed_.data(); }
  /// Works out where a body ends, and the energy that this makes: a step weighs impulses by how
  /// the body lay when it began.
  double end(const StepContext& step, BodySlot body, const BodyRow& row, const Mat3f& root_W,
             const Bodies& bodies);
  /// Instead, so that it makes none: in a slightly other rotation, or else with its energy and not
  /// its momentum.
  void keep_energy(BodySlot body, const BodyRow& row, const Mat3f& root_W, const Bodies& bodies);
  const Turning& turning(BodySlot body) const { return spin_[body].turning; }
  /// Whether it makes energy to end there.
  bool makes(BodySlot body) const { return spin_[body].made_J > 0; }

 private:
  struct Spin {
    Vec3 momentum_W;
    Turning turning;  ///< Without impulses; in the end, with them.
    double made_J = 0;
    bool wobbles = false;
  };

  ByBody<Spin> spin_;
  std::vector<Wide> owed_;
};

}  // namespace sunder::solver
