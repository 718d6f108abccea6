// Planar scenes, which move in the plane z = 0 alone: checks, and a unit of length for the solver.
#pragma once

#include <string>

#include "engine/model/scene.h"

namespace sunder::scenes {

/// Throws InputError that begins with `where` and names the solid, ball, joint or action if any of
/// the scene needs a third dimension.
void check_planar(const Scene& scene, const std::string& where);
/// Returns the typical size of a piece in the plane, in m: the geometric mean over convexes and
/// balls, rounded to a power of two, so that a change of units is exact; 1 if there are none.
double planar_piece_m(const Scene& scene);

}  // namespace sunder::scenes
