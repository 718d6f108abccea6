// Solids that are built in, for the program, tests and benchmarks.
#pragma once

#include <cstdint>
#include <string>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// One box; `anchored` as in Compound.
Compound box_compound(const Vec3& min, const Vec3& max, std::uint8_t anchored = 0);
/// nx × ny × nz touching boxes of a size, one corner at the origin; the lowest may be anchored.
Compound grid_compound(int nx, int ny, int nz, const Vec3& size = Vec3::Ones(),
                       bool anchored = false);
/// The unit cube around the origin, in `count` Voronoi cells.
Compound voronoi_compound(int count, std::uint64_t seed);
/// A ring of prisms around y, from y = 0 to `height`.
Compound ring_compound(int segments, double inner, double outer, double height);

/// The solid that a name stands for: box:X,Y,Z column:R,H torus:R,r grid:NX,NY,NZ voronoi:N
/// hall:N, in metres; grids lie in [0, N], a hall (N columns that reach into their roof, anchored
/// at the foot) stands at the origin, and the others lie around it. Throws InputError that says
/// what is allowed.
Compound make_solid(const std::string& name);

}  // namespace sunder::fracture
