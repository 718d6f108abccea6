// What no solver can make sense of.
#pragma once

#include <span>

#include "engine/model/physics.h"

namespace sunder::solver {

/// Throws InputError naming the body and what is wrong if a number is not finite, a mass, inertia
/// or size is not positive, or a friction is negative. Nothing has changed then.
void check_bodies(std::span<const BodyDesc> bodies);
/// The same for the shapes of the body with this tag.
void check_shapes(std::span<const ShapeDesc> shapes, std::uint32_t body_tag);

}  // namespace sunder::solver
