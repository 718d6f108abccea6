// The plane that cuts a concave piece so that the hulls of its two sides are smallest.
//
// Read first: best_cut(). For each of some directions the mesh is sliced across it, and two sweeps
// over the slices' outlines (sweep.h) price the cut at every slice; the best is then tilted
// and shifted a little, again and again.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// About the convex hull of a mesh.
struct Outline {
  std::vector<Vec3> points;  ///< The vertices that matter for it, each once.
  double hull_m3 = 0;        ///< Its volume; 0 where the mesh is flat.
};
/// Of a mesh.
Outline outline_of(const PolygonMesh& mesh);

/// A plane that leaves part of a mesh on either side, and the volume of both sides' hulls together,
/// about.
struct Cut {
  Plane plane;
  double hull_volume_m3 = 0;
};
/// How many directions are tried, and how far the best is refined.
enum class Effort { kLittle, kFull };

/// The cut whose hulls are smallest; none for a mesh too flat to tell. `outline` is the mesh's.
std::optional<Cut> best_cut(const PolygonMesh& mesh, const Outline& outline, Effort effort);
/// Cuts in several directions whose sides are about as large, those with the smallest hulls first.
std::vector<Cut> middle_cuts(const PolygonMesh& mesh, const Outline& outline);

}  // namespace sunder::fracture
