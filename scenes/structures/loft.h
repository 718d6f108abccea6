// Parts with curved surfaces: a visual mesh lofted from ring to ring, in a convex of few faces.
//
// Read first: loft(). Surfaces of revolution (columns, balusters) and sweeps along a line or an
// arch are all lofts between rings with equal numbers of points.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/polygon_mesh.h"
#include "engine/model/compound.h"

namespace sunder::scenes {

/// A closed polygon in space.
using Ring = std::vector<Vec3>;

/// Returns the solid between rings, each of which is joined to the next point by point, with a flat
/// face at either end. Quadrangles that are not flat are split into triangles. Edges between faces
/// at less than 40° are shaded smooth.
PolygonMesh loft(std::span<const Ring> rings);

/// A path of straight lines and parabolas in a plane, such as the profile of a moulding.
class Profile {
 public:
  Profile(double x, double y) : points_{{x, y}} {}
  /// Appends a line to (x, y).
  Profile& to(double x, double y);
  /// Appends a quadratic Bézier curve to (x, y), as `segments` lines.
  Profile& curve(const Vec2& control, double x, double y, int segments);
  const std::vector<Vec2>& points() const { return points_; }

 private:
  std::vector<Vec2> points_;
};

/// Returns the rings of a solid about y: an outline in x and z of about unit radius, scaled and
/// raised by each (radius, height) of the profile, which is given from below.
std::vector<Ring> turned(std::span<const Vec2> outline, std::span<const Vec2> profile);
/// Returns a circle of unit radius.
std::vector<Vec2> circle(int segments);
/// Returns the outline of a fluted shaft of unit radius; for depth 0, a circle of as many points.
std::vector<Vec2> fluted(int flutes, int segments, double depth);

/// Returns an upright regular prism about y with `sides` sides that encloses the rings.
ConvexPolyhedron prism_around(std::span<const Ring> rings, int sides);
/// Returns the prism on a convex polygon of (x, z) between two heights.
ConvexPolyhedron block(std::span<const Vec2> plan_xz, double bottom, double top);

/// Returns a part whose visual mesh is the solid between rings, and whose convex is `region`, which
/// must enclose the rings, clipped to fit them.
Part lofted(std::span<const Ring> rings, const ConvexPolyhedron& region, MaterialIndex material);

}  // namespace sunder::scenes
