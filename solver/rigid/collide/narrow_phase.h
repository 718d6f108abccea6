// What two near shapes do: nothing, touch, or will touch within the step.
#pragma once

#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/manifold_build.h"

namespace sunder::solver {

struct NarrowScratch {
  HullScratch hulls;
  PatchScratch patch;
  std::vector<PatchPoint> points;
};

/// How far a body may come within the step.
struct StepReach {
  Vec3f way_W;
  float spin_m;  ///< Of any of its points about its centre.
};

/// Whether a pair needs no look: it touches (`m` is given) and its bodies have not moved against
/// each other since the last one, or it is too far apart to touch within the step.
bool same_as_before(const Bodies& bodies, SpanByBody<const StepReach> reach, const Pair& pair,
                    const Manifold* m);

/// Asks for the memory of pairs that are looked at soon after `at`: of what a look reads first and,
/// nearer by, of hulls.
void prefetch_pairs(PairSlot at, PairSlot end, const Contacts& contacts, const Shapes& shapes,
                    const Bodies& bodies);

/// Brings the manifold of a pair up to date: carried along while the pair barely moves, otherwise
/// made anew. Pairs that close fast are moved to the time of impact first, so that the normal is
/// that of the feature that will be hit.
void update_contact(const StepContext& step, const Shapes& shapes, const Bodies& bodies, Pair& pair,
                    Manifold& m, NarrowScratch& scratch);

/// The point of the hull's surface closest to `point` (hull frame): `normal` away from the hull,
/// the distance negative inside.
struct HullDistance {
  Vec3f normal = Vec3f::UnitY();
  float distance_m = 0;
};
HullDistance distance_to_hull(const Hull& hull, const Vec3f& point);

}  // namespace sunder::solver
