// What materials look like, as numbers for the shaders.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/model/material.h"

namespace sunder::render {

/// Texels (RGBA, float) of `materials` in pieces.vert: two rows a material, its surface and its
/// interior, of three texels each.
inline constexpr std::size_t kTexelsAMaterial = 6;
std::vector<float> material_rows(std::span<const Material> materials);

}  // namespace sunder::render
