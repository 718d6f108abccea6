// Data layers as images of 8 bits, to look at and to compare.
#pragma once

#include "render/image/image.h"

namespace sunder::render {

/// Returns a layer as an image. Depth is red, with bands of green and blue that repeat several
/// times as the depth doubles, so that a change of half a percent is visible; infinity is white.
/// Each body has a colour of its own. Normals have their own values.
Image layer_picture(const Layer& layer, int width, int height);

}  // namespace sunder::render
