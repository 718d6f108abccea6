// Appearance of blocks: bricks and ashlars that are a body each, and pieces of them.
#pragma once

#include <cstdint>

#include "engine/model/frame.h"

namespace sunder::render {

/// Sides of the bounding box of a mesh, in coordinates of the mesh. A side on which no face of the
/// original surface lies is at ±1e4 m.
struct BlockSides {
  Vec3f low = Vec3f::Zero();
  Vec3f high = Vec3f::Zero();
};
BlockSides sides_of(const Mesh& mesh, const Box& box);

/// Variation of the colour of a block: factor of brightness, and excess of red over green.
struct BlockTone {
  float brightness = 1;
  float redness = 0;
};
/// Returns the tone of a body, which depends on its key alone and so stays for a run.
BlockTone tone_of(std::uint64_t body_key);

}  // namespace sunder::render
