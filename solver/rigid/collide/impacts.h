// Where bodies meet so fast that a step is long for it: what touches, near there, has to pass the
// impact on within the substep (docs/decisions/036).
#pragma once

#include <cstdint>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// What closes no faster in a step is no impact: its overlaps are small against it, or gravity
/// alone may have made it so fast.
double least_impact_m_s(const StepContext& step, const Manifold& m);

class Impacts {
 public:
  void clear() { steps_.clear(); }
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
  static constexpr std::uint8_t kReach = 4;  ///< From body to body.
  static constexpr std::uint8_t kUnreached = 255;

  bool is_near(BodySlot body) const { return steps_[body] < kReach; }

  ByBody<std::uint8_t> steps_;  ///< From a body that is struck. Empty: none is.
};

}  // namespace sunder::solver
