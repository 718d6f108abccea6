// What materials look like, as numbers for the shaders.
#pragma once

#include <span>
#include <vector>

#include "engine/model/material.h"

namespace sunder::render {

/// Texels (RGBA, float) of `looks` in pieces.vert: for every material its surface, then its
/// interior, three texels each.
std::vector<float> look_texels(std::span<const Material> materials);

}  // namespace sunder::render
