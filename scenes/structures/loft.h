// Members of curved stone: a visual mesh drawn from ring to ring, in a convex of few faces.
//
// Read first: loft(). What is turned (columns, balusters), swept along a line or round an arch is
// all the same: rings of equally many points.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/polygon_mesh.h"
#include "engine/model/compound.h"

namespace sunder::scenes {

/// A closed polygon in space.
using Ring = std::vector<Vec3>;

/// The solid between rings, each joined to the next point by point, with a flat face at either end.
/// Quadrangles that are not flat are halved; shaded round where faces meet at less than 40°.
PolygonMesh loft(std::span<const Ring> rings);

/// A line of straight and curved strokes: the profile of a moulding.
class Profile {
 public:
  Profile(double x, double y) : points_{{x, y}} {}
  Profile& to(double x, double y);
  /// A parabola from where it ends, to (x, y), that leaves and arrives in the direction of
  /// `control`.
  Profile& curve(const Vec2& control, double x, double y, int segments);
  const std::vector<Vec2>& points() const { return points_; }

 private:
  std::vector<Vec2> points_;
};

/// What is turned on a lathe about y: an outline of about unit radius in x and z, in the sizes of a
/// profile of (radius, height), from below.
std::vector<Ring> turned(std::span<const Vec2> outline, std::span<const Vec2> profile);
/// A circle of unit radius.
std::vector<Vec2> circle(int segments);
/// The outline of a fluted shaft of unit radius; 0 deep: a circle with the same points.
std::vector<Vec2> fluted(int flutes, int segments, double depth);

/// An upright prism about y that encloses the rings, with `sides` sides.
ConvexPolyhedron prism_around(std::span<const Ring> rings, int sides);
/// The convex solid with these corners at two heights; a prism if both are the same.
ConvexPolyhedron block(std::span<const Vec2> plan_xz, double bottom, double top);

/// A part seen as the solid between rings. It collides as `region`, which encloses it, clipped to
/// fit.
Part lofted(std::span<const Ring> rings, const ConvexPolyhedron& region, MaterialIndex material);

}  // namespace sunder::scenes
