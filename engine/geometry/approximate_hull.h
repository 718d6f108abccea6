// Convex polyhedra with few faces that enclose points tightly (paper 4.2, figures 11 and 13).
//
// A convex that encloses points is fitted by clipping it with supporting planes of the points: the
// result still encloses the points and lies within the original convex. The plane normals are fixed
// (k-DOPs) or the face normals of the hull that algorithm 1 of the paper builds.
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

/// Returns the name of a fit: aabb, 14dop, 26dop or hull:N, N from 4 to kMaxFitVertices.
std::string name_of(const Fit& fit);
/// Returns the fit of a name; none if the name is unknown.
std::optional<Fit> parse_fit(std::string_view name);
/// Largest number of vertices of a hull fit.
inline constexpr std::uint32_t kMaxFitVertices = 1000;
/// The valid names of fits, for messages.
inline constexpr std::string_view kFitNames = "aabb | 14dop | 26dop | hull:N, N from 4 to 1000";

/// Returns 26 unit directions, each followed by its negative. The first 6, 14 or 26 of them are
/// those of the box, the 14-DOP and the 26-DOP (paper, equations 1 to 3).
std::span<const Vec3> dop_directions();

/// The hull of some of the points, as an approximation of the hull of all.
struct ApproximateHull {
  std::vector<std::uint32_t> vertices;  ///< Indices of points, in order of addition.
  std::vector<Vec3> directions;         ///< Unit normals of its faces, outward.
  double volume_m3 = 0;  ///< Volume of the hull of `vertices`; at most the true hull's.
};

/// Returns the hull of up to `vertex_count` points (paper, algorithm 1): adds the point that adds
/// most volume until no point is left outside. Empty if the points span no volume.
ApproximateHull approximate_hull(std::span<const Vec3> points, std::size_t vertex_count);

/// Returns the face normals of a fit; those of the 26-DOP for a hull of points that span no volume.
std::vector<Vec3> fit_directions(std::span<const Vec3> points, const Fit& fit);
/// Returns for each direction the supporting plane of the points, in the order of the directions.
std::vector<Plane> touching_planes(std::span<const Vec3> points, std::span<const Vec3> directions);
/// Returns the part of `convex` inside all planes. New faces get the plane's element of `ids`,
/// which has one id for each plane. Vertices within `tolerance_m` of a plane count as on it. Planes
/// that do not cut the convex are ignored, also those that have all of it outside.
ConvexPolyhedron clip_all(const ConvexPolyhedron& convex, std::span<const Plane> planes,
                          std::span<const PlaneId> ids, double tolerance_m);
/// Returns the bounding box of the points, clipped to fit, with faces without ids. A flat box is
/// first thickened by about 1e-9 of its size. Empty if there are no points.
ConvexPolyhedron fitted_hull(std::span<const Vec3> points, const Fit& fit);

}  // namespace sunder
