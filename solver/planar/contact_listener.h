// What contacts did over a solve, as Box2D tells it step by step.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "solver/planar/planar_bodies.h"

namespace sunder::solver {

/// Sums up impulses, in units.
class ContactListener final : public b2ContactListener {
 public:
  explicit ContactListener(std::vector<PlanarBody>& bodies) : bodies_(bodies) {}

  /// What one pair of shapes passed on, on the second.
  struct Passed {
    std::uint32_t body_a = 0, body_b = 0;
    b2Vec2 impulse = {0, 0};
    b2Vec2 moment = {0, 0};  ///< Points weighed by their impulses.
    float weight = 0;
    int steps = 0;
    bool ended = false;  ///< They parted, or one is gone.
  };
  using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< Slots of shapes, ascending.

  /// Forgets what was passed on, but for pairs asleep.
  void begin();
  /// Pairs that fell asleep in between carry on with what they would have passed in all steps.
  void end(int steps);

  b2Vec2 from_static = {0, 0};    ///< On moving bodies since begin().
  std::map<Pair, Passed> passed;  ///< Where one of the bodies bears load.

 private:
  void EndContact(b2Contact* contact) override;
  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override;
  bool asleep(const Passed& p) const;

  std::vector<PlanarBody>& bodies_;
};

}  // namespace sunder::solver
