// Anti-aliasing of a finished image.
#pragma once

#include <cstdint>
#include <span>

#include "render/image/image.h"

namespace sunder::render {

/// Applies fast approximate anti-aliasing (Lottes, "FXAA", 2009): finds edges by brightness,
/// searches their ends and blends pixels by their position on the stair step. Runs on the CPU,
/// because few pixels are on edges, while a software GL driver would run a shader on all. A pixel
/// holds red, green, blue and brightness, from the lowest byte up.
Image apply_fxaa(std::span<const std::uint32_t> pixels, int width, int height);

}  // namespace sunder::render
