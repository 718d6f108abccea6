// What a paint's picture of relief says: normals, or heights that have normals.
#pragma once

#include "engine/base/types.h"
#include "render/image/image.h"

namespace sunder::render {

/// The normals of a picture of relief as colours, so many times steeper along it and up in it.
Image normals_of(const Image& relief, float steeper_along, float steeper_up);

/// A picture of normals in place of one of heights; any other is itself. Throws InputError for what
/// is neither PNG nor JPEG.
Picture as_normals(const Picture& relief);

}  // namespace sunder::render
