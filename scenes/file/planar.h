// Scenes without a third dimension: what they may hold.
#pragma once

#include <string>

#include "engine/model/scene.h"

namespace sunder::scenes {

/// Throws InputError, beginning with `where` and naming what it is about, if something in the scene
/// needs a third dimension.
void check_planar(const Scene& scene, const std::string& where);
/// The size of its usual piece in the plane: the geometric mean over convexes and balls, as a power
/// of two of a metre, so that changing units costs no digits; 1 if there are none.
double planar_piece_m(const Scene& scene);

}  // namespace sunder::scenes
