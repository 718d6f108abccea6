// Quick tests of queries against shapes, in floats: they never miss, and seldom let pass what the
// exact test in double precision would refuse.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/box_tree.h"

namespace sunder::solver {

/// Returns false if a ray, or the path of a ball, certainly misses a hull.
bool may_meet(const Ray& ray, const Shape& shape, const Bodies& bodies);
/// Returns false if a face of a hull certainly separates the hull from a box.
bool may_overlap(const FloatBox& box_W, const Shape& shape, const Bodies& bodies);

}  // namespace sunder::solver
