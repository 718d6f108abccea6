// Normal maps from the relief textures of mesh files, which are normal maps or height maps.
#pragma once

#include "engine/base/types.h"
#include "render/image/image.h"

namespace sunder::render {

/// Returns the normal map of a relief texture (a normal map, or a height map if it is all grey),
/// with slopes scaled by `scale_along` along its rows and by `scale_up` up its columns.
Image make_normal_map(const Image& relief, float scale_along, float scale_up);

/// Converts a height map to a normal map; returns any other picture unchanged. Throws InputError if
/// the picture is neither PNG nor JPEG.
EncodedImage as_normal_map(const EncodedImage& relief);

}  // namespace sunder::render
