// Fraction of a frame's volume that belongs to static bodies.
#pragma once

#include <cstdint>

#include "engine/model/frame.h"

namespace sunder::truths {

/// Returns the volume of static bodies divided by the volume of all bodies, without that of body
/// `other_key`; 1 if there is no volume.
inline double share_standing(const Frame& frame, std::uint64_t other_key = kGroundKey) {
  double all_m3 = 0, static_m3 = 0;
  for (const Instance& instance : frame.instances) {
    const FrameBody& body = frame.bodies[instance.body];
    if (body.key == other_key) continue;
    const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
    double volume_m3 = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) -> const Vec3f& {
        return mesh.vertices[mesh.indices[i + k]].position;
      };
      volume_m3 += double{corner(0).cross(corner(1)).dot(corner(2))} / 6;
    }
    all_m3 += volume_m3;
    if (body.is_static) static_m3 += volume_m3;
  }
  return all_m3 > 0 ? static_m3 / all_m3 : 1;
}

}  // namespace sunder::truths
