// Facets: triangles of a surface that collide on their front. A body that slides from one facet to
// the next must not hit the edge between them, although it enters the prism of the next one.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/separation.h"

namespace sunder::solver {

/// Returns the axis of a facet's front, which is the first face of its hull.
SeparatingAxis front_axis(const Hull& facet, float separation_m);
/// True if a direction away from a facet, in its body's frame, is a normal of the surface there:
/// that of the front, or one over an edge within the bend to the next facet.
bool normal_to_surface(const Shape& facet, const Vec3f& normal_A);
/// True if a point is in front of the facet's back, so that it is pushed out.
bool before_back(const Hull& facet, const Vec3f& point_A);
/// True if a point is over or under the triangle. If `on_the_way`, a point beyond an edge counts
/// where the surface continues straight or rises: a fast shape from there is soon over the
/// triangle.
bool over_triangle(const Shape& facet, const Vec3f& point_A, float tolerance_m, bool on_the_way);
/// Returns the distance from the front to the back.
float depth_m(const Hull& facet);

}  // namespace sunder::solver
