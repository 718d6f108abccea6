// Things of a scene by their names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Indices of solids, then of balls; the parts "wall.0", "wall.1" … of a structure go by "wall"
/// together. Throws InputError with the place of `value` if there is none.
std::vector<std::uint32_t> roots_named(const Scene& scene, const std::string& name,
                                       const Value& value);

/// Whether the world holds a solid; balls it never holds.
bool is_anchored(const Scene& scene, std::uint32_t root);

}  // namespace sunder::scenes
