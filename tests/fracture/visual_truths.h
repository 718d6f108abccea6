// Invariants of fracture for convexes with visual meshes.
#pragma once

#include <string>

#include "engine/geometry/polygon_mesh.h"
#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Returns an empty string if a break of `parent` keeps all invariants, those of its meshes
/// included; otherwise the first violation.
std::string find_visual_violation(const Compound& parent, const BreakPlan& plan);

/// Returns the winding number of meshes, and of polyhedra of internal convexes, around a point.
int winding(std::span<const Compound> compounds, const Vec3& point);

/// Returns a compound of one surface convex around a mesh.
Compound solid_of(PolygonMesh mesh, std::uint8_t anchored = 0);

}  // namespace sunder::fracture
