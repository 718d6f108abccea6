// Projection of faces to two dimensions, and contacts among the faces of one plane. Internal to
// fracture/adjacency.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/polygon.h"

namespace sunder::fracture {

/// Least area of a contact over the squared size of the smaller convex.
inline constexpr double kMinContactArea = 1e-10;

/// A face projected along the axis nearest to its normal.
struct ProjectedFace {
  PlaneId id;
  const Vec2* points = nullptr;  ///< Projected polygon; valid once its bin is complete.
  double scale = 1;              ///< Area of the face over that of the projected polygon.
  double size = 0;               ///< Size of its convex; see size_of().
  std::uint32_t convex = 0, face = 0;
  std::uint32_t first_point = 0, point_count = 0;  ///< Indices in the points of its bin.
  std::uint32_t cap = FaceEntry::kNoCap;
  std::uint8_t dropped = 0;  ///< Axis of the projection.
  bool known = false;

  std::span<const Vec2> polygon() const { return {points, point_count}; }
};

/// Returns the longest side of a convex's box.
inline double size_of(const Convex& convex) { return convex.box.extent().maxCoeff(); }

/// Appends the projection of a face, or of its cap, along axis `dropped`; counter-clockwise on
/// either side of the plane.
void project_face(const Convex& convex, std::size_t face, std::uint32_t cap, int dropped,
                  std::vector<Vec2>& points);

/// Appends the contacts among `faces`, which are faces of `convexes`; changes the projections.
void sweep_planes(std::span<const ConvexPtr> convexes, std::vector<ProjectedFace>& faces,
                  std::vector<Bond>& bonds);

}  // namespace sunder::fracture
