// Impacts: bodies that close so fast that a step is long for their contact. The contacts near an
// impact propagate it within the substep (docs/decisions/036).
#pragma once

#include <cstdint>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Returns the minimum closing speed of an impact: at a lower one the overlaps of a step are small,
/// or gravity alone may have caused the speed.
double least_impact_m_s(const StepContext& step, const Manifold& m);

class Impacts {
 public:
  void clear() { distance_.clear(); }
  /// Finds the impacts among awake contacts, and the bodies near them.
  void find(const StepContext& step, const Bodies& bodies, const Contacts& contacts);
  bool empty() const { return distance_.empty(); }
  /// True if a manifold of awake bodies propagates an impact.
  bool propagates(const Manifold& m) const {
    return !empty() && (is_near(m.body_a) || is_near(m.body_b));
  }
  /// True if manifolds near an impact can move the body.
  bool may_move(BodySlot body) const { return !empty() && distance_[body] <= kMaxDistance; }

 private:
  static constexpr std::uint8_t kMaxDistance = 4;  ///< Number of contacts from a struck body.
  static constexpr std::uint8_t kUnreached = 255;

  bool is_near(BodySlot body) const { return distance_[body] < kMaxDistance; }

  /// Number of contacts from a struck body; empty: there is no impact.
  ByBody<std::uint8_t> distance_;
};

}  // namespace sunder::solver
