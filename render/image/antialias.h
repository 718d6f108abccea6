// Smooths the stairs of edges in a finished picture.
#pragma once

#include <cstdint>
#include <span>

#include "render/image/image.h"

namespace sunder::render {

/// Fast approximate anti-aliasing (Lottes, "FXAA", 2009): finds edges by their brightness, follows
/// each to its ends and blends its pixels by where on the stair they are. On the processor: few
/// pixels are on edges, and a software GL driver would run the shader on all of them. A pixel is
/// red, green, blue and its brightness, from the lowest byte up.
Image antialiased(std::span<const std::uint32_t> pixels, int width, int height);

}  // namespace sunder::render
