// Finds the plane that cuts a concave piece so that the hulls of its two sides are smallest.
//
// Read first: best_cut(). The mesh is sliced in several directions. Two sweeps over the outlines of
// the slices (sweep.h) give the hull volumes of a cut at every slice; the best cut is then refined
// by tilts and shifts.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// Approximate convex hull of a mesh.
struct Outline {
  std::vector<Vec3> points;  ///< Vertices that contribute to the hull, each once.
  double hull_m3 = 0;        ///< Volume of the hull; 0 if the mesh is flat.
};
/// Returns the outline of a mesh.
Outline outline_of(const PolygonMesh& mesh);

/// A plane that cuts a mesh, and the approximate total volume of the hulls of both sides.
struct Cut {
  Plane plane;
  double hull_volume_m3 = 0;
};
/// Effort of a search: kLittle tries the first directions, kFull also refines the best cut.
enum class Effort { kLittle, kFull };

/// Returns the cut with the smallest hulls; nullopt if the mesh is too flat.
std::optional<Cut> best_cut(const PolygonMesh& mesh, const Outline& outline, Effort effort);
/// Returns one cut per direction with sides of about equal size; those with least hulls first.
std::vector<Cut> middle_cuts(const PolygonMesh& mesh, const Outline& outline);

}  // namespace sunder::fracture
