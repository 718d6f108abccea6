// Tests two near shapes: they are apart, touch, or will touch within the step.
#pragma once

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

/// Motion of a body within the step.
struct StepReach {
  Vec3f displacement_W;
  float spin_m;  ///< Upper bound on the motion of its points about its centre.
};

/// True if a pair needs no test: it touches (`m` is given) and its bodies have not moved against
/// each other since the last test, or it is too far apart to touch within the step.
bool same_as_before(const Bodies& bodies, SpanByBody<const StepReach> reach, const Pair& pair,
                    const Manifold* m);

/// Prefetches memory of the pairs that are tested soon after `at`: first pairs, manifolds and
/// shapes, then hulls.
void prefetch_pairs(PairSlot at, PairSlot end, const Contacts& contacts, const Shapes& shapes,
                    const Bodies& bodies);

/// Updates the manifold of a pair: keeps its points while the pair barely moves, else builds it
/// again. Fast pairs are first cast to their time of impact, so that the normal is that of the
/// feature that will be hit.
void update_contact(const StepContext& step, const Shapes& shapes, const Bodies& bodies, Pair& pair,
                    Manifold& m, NarrowScratch& scratch);

/// Returns the distance of two shapes at a pose, negative if they overlap; any distance apart may
/// be given for the true one. They are in the order of Pair.
float separation_m(const Shape& a, const Shape& b, const RelativePose& pose,
                   NarrowScratch& scratch);

/// Point of a hull's surface closest to a point, by its distance (negative inside) and the normal
/// away from the hull, in the hull's frame.
struct HullDistance {
  Vec3f normal = Vec3f::UnitY();
  float distance_m = 0;
};
HullDistance distance_to_hull(const Hull& hull, const Vec3f& point);

}  // namespace sunder::solver
