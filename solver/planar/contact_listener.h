// Sums of contact impulses over a solve, from Box2D's callbacks in each of its steps.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "solver/planar/planar_bodies.h"

namespace sunder::solver {

/// Sums contact impulses. Lengths are in Box2D units (Plane2), impulses in kg · units/s.
class ContactListener final : public b2ContactListener {
 public:
  explicit ContactListener(std::vector<PlanarBody>& bodies) : bodies_(bodies) {}

  /// Sum of the impulses on the second of a pair of shapes.
  struct PairImpulse {
    std::uint32_t body_a = 0, body_b = 0;
    b2Vec2 impulse = {0, 0};
    b2Vec2 moment = {0, 0};  ///< Sum of contact points, weighted by their normal impulses.
    float weight = 0;        ///< Sum of the normal impulses.
    int steps = 0;           ///< Box2D steps with contact; -1: the sum is from an earlier solve.
    bool ended = false;      ///< True if the shapes separated or one was removed.
  };
  using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< Shape slots in ascending order.

  /// Starts a solve: drops the sums of all pairs but sleeping ones, which it multiplies by
  /// `scale`, the length of the solve over that of the last one.
  void begin(float scale);
  /// Ends a solve of `steps` Box2D steps: extrapolates pairs that fell asleep in it to all steps.
  void end(int steps);

  b2Vec2 impulse_from_static = {0, 0};  ///< Impulse of static bodies on dynamic ones since begin().
  std::map<Pair, PairImpulse> pair_impulses;  ///< Pairs in which a body has reports_load set.

 private:
  void EndContact(b2Contact* contact) override;
  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override;
  bool are_asleep(const PairImpulse& p) const;

  std::vector<PlanarBody>& bodies_;
};

}  // namespace sunder::solver
