// Tight convexes with few faces around many points (paper 4.2, figures 11 and 13).
//
// A convex is fitted by clipping it with planes pushed onto the points from given directions: it
// then still encloses them, and still lies within the convex that it was. The directions are
// fixed (k-dops), or the face normals of algorithm 1's hull.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// What a fit is called: aabb, 14dop, 26dop or hull:N, N from 4 to kMostFitVertices.
std::string name_of(const Fit& fit);
/// The fit of that name; none if there is no such.
std::optional<Fit> parse_fit(std::string_view name);
/// Of a hull to fit.
inline constexpr std::uint32_t kMostFitVertices = 1000;
/// The names that there are, for messages.
inline constexpr std::string_view kFitNames = "aabb | 14dop | 26dop | hull:N, N from 4 to 1000";

/// The first 6, 14 or 26 are the unit directions of the box, 14-dop and 26-dop (equations 1 to 3),
/// each followed by its negative.
std::span<const Vec3> dop_directions();

/// Part of a convex hull, from some of its points.
struct ApproximateHull {
  std::vector<std::uint32_t> vertices;  ///< Indices of points, in the order they were included.
  std::vector<Vec3> directions;         ///< Unit normals of its faces, outward.
  double volume_m3 = 0;                 ///< Of the hull of `vertices`: it grows to the true hull's.
};

/// Algorithm 1: includes the point that adds most volume, until there are `vertex_count` vertices
/// or nothing is left outside. Empty if the points span no volume.
ApproximateHull approximate_hull(std::span<const Vec3> points, std::size_t vertex_count);

/// The directions of a fit; those of the 26-dop where the points span no volume.
std::vector<Vec3> fit_directions(std::span<const Vec3> points, const Fit& fit);
/// Per direction the plane that touches the points from outside.
std::vector<Plane> touching_planes(std::span<const Vec3> points, std::span<const Vec3> directions);
/// The part of `convex` inside all planes, whose faces get `ids` (as many as there are planes).
/// Distances within `tolerance_m` count as on a plane. Planes that miss the convex, or would leave
/// nothing of it, do nothing.
ConvexPolyhedron clip_all(const ConvexPolyhedron& convex, std::span<const Plane> planes,
                          std::span<const PlaneId> ids, double tolerance_m);
/// The bounding box of the points clipped to fit; without ids. A flat box is thickened a little.
ConvexPolyhedron fitted_hull(std::span<const Vec3> points, const Fit& fit);

}  // namespace sunder
