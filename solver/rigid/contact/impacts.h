// Where something heavy strikes light bodies fast: what touches, near there, has to pass that on
// within the substep (docs/decisions/036).
#pragma once

#include <cstdint>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

class Impacts {
 public:
  /// Finds them among what touches, and what is near.
  void find(const StepContext& step, const Bodies& bodies, const Contacts& contacts);
  bool empty() const { return steps_.empty(); }
  /// Whether a manifold of awake bodies has to pass an impact on.
  bool near(const Manifold& m) const {
    return !empty() && (is_near(m.body_a) || is_near(m.body_b));
  }
  /// Bodies that manifolds near an impact move.
  bool moves(BodySlot body) const { return !empty() && steps_[body] <= kReach; }

 private:
  static constexpr std::uint8_t kReach = 8;  ///< From body to body.
  static constexpr std::uint8_t kFar = 255;

  bool is_near(BodySlot body) const { return steps_[body] < kReach; }
  void spread(const Bodies& bodies, const Contacts& contacts);

  ByBody<std::uint8_t> steps_;  ///< From a body that is struck. Empty: none is.
};

}  // namespace sunder::solver
