// A draped figure that holds up a torch: the mesh for the scene of the paper's figure 10, which
// shows a dragon.
#pragma once

#include <cstdint>

#include "engine/geometry/raw_mesh.h"

namespace sunder::scenes {

/// Returns a closed, smooth mesh of about `triangles` triangles, from 1,000 to 1,000,000. It is 2.3
/// m tall with its base, which stands on y = 0, and faces +z.
RawMesh make_statue(std::uint32_t triangles);

}  // namespace sunder::scenes
