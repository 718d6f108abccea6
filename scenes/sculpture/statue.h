// A draped figure that holds up a torch: the statue of the paper's figure 10, where it has a
// dragon.
#pragma once

#include <cstdint>

#include "engine/geometry/raw_mesh.h"

namespace sunder::scenes {

/// A closed, smooth mesh of about so many triangles, from 1,000 to 1,000,000: 2.3 m tall with its
/// base, which stands on y = 0; it faces +z.
RawMesh make_statue(std::uint32_t triangles);

}  // namespace sunder::scenes
