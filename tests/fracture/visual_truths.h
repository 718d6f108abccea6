// The truths of fracture for convexes that own visual meshes.
#pragma once

#include <string>

#include "engine/geometry/polygon_mesh.h"
#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Empty if all is true of a break of `parent`, its meshes included; otherwise what is not.
std::string broken_visual_truth(const Compound& parent, const BreakPlan& plan);

/// How often what the compounds hold (meshes, and polyhedra of internal convexes) is around a
/// point.
int winding(std::span<const Compound> compounds, const Vec3& point);

/// One surface convex around a mesh.
Compound solid_of(PolygonMesh mesh, std::uint8_t anchored = 0);

}  // namespace sunder::fracture
