// Facets: triangles of a surface that are met from their front. A body that slides from one to the
// next must not feel the edge between them, though it runs into the next one's prism there.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/separation.h"

namespace sunder::solver {

/// The axis of a facet's front: the first face of its hull.
SeparatingAxis front_axis(const Hull& facet, float separation_m);
/// Whether a direction away from a facet, in its body's frame, is one of the normals that the
/// surface has there: the front's, or over an edge no farther from it than the surface bends away.
bool normal_to_surface(const Shape& facet, const Vec3f& normal_A);
/// Whether a point is in front of the facet's back, so that what is there is to be pushed out.
bool before_back(const Hull& facet, const Vec3f& point_A);
/// Whether a point is over the triangle or under it; or, if `on_the_way`, beyond an edge where the
/// surface goes on straight or rises: who comes from there will be over it before long.
bool over_triangle(const Shape& facet, const Vec3f& point_A, float tolerance_m, bool on_the_way);
/// From the front to the back.
float depth_m(const Hull& facet);

}  // namespace sunder::solver
