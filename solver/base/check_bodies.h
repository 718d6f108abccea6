// Validation of body and shape descriptions, for all solvers.
#pragma once

#include <span>

#include "engine/model/physics.h"

namespace sunder::solver {

/// Throws InputError that names the body and the fault if a number is not finite, a mass, inertia
/// or size is not positive, or a friction is negative.
void check_bodies(std::span<const BodyDesc> bodies);
/// Throws InputError as check_bodies() does for faulty shapes of the body with this tag.
void check_shapes(std::span<const ShapeDesc> shapes, std::uint32_t body_tag);

}  // namespace sunder::solver
