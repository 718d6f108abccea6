// Built-in solids for the program, tests and benchmarks.
#pragma once

#include <cstdint>
#include <string>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// Returns one box; `anchored` as in Compound.
Compound box_compound(const Vec3& min, const Vec3& max, std::uint8_t anchored = 0);
/// Returns nx × ny × nz touching boxes of equal size, with one corner at the origin; `anchored`
/// anchors the lowest layer.
Compound grid_compound(int nx, int ny, int nz, const Vec3& size = Vec3::Ones(),
                       bool anchored = false);
/// Returns the unit cube around the origin, divided into `count` Voronoi cells.
Compound voronoi_compound(int count, std::uint64_t seed);

/// Returns the solid that `name` describes, in metres: box:X,Y,Z column:R,H torus:R,r grid:NX,NY,NZ
/// voronoi:N hall:N. Grids lie in [0, N]. A hall has N columns that overlap with their roof, is
/// anchored at the foot and stands at the origin. All others are centred at the origin. Throws
/// InputError, with the names allowed, if `name` is none of these.
Compound make_solid(const std::string& name);

}  // namespace sunder::fracture
