// The appearance of materials as texels for the shaders.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/model/material.h"

namespace sunder::render {

/// Number of texels of a material in material_rows().
inline constexpr std::size_t kTexelsPerMaterial = 6;
/// Returns the texels (RGBA, float) of `materials` for pieces.vert: for each material a row for its
/// surface and one for its interior, of three texels each.
std::vector<float> material_rows(std::span<const Material> materials);

}  // namespace sunder::render
