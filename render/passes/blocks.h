// Looks of blocks: bricks and ashlars that are a body each, and what has come off them.
#pragma once

#include <cstdint>

#include "engine/model/frame.h"

namespace sunder::render {

/// Sides of the box around a mesh, in the mesh's coordinates: far off where no face of the old
/// surface lies on a side.
struct BlockSides {
  Vec3f low = Vec3f::Zero();
  Vec3f high = Vec3f::Zero();
};
BlockSides sides_of(const Mesh& mesh, const Box& box);

/// Factors on the colour of a block: brightness, and how much more red than green it has.
struct BlockTone {
  float brightness = 1;
  float redness = 0;
};
/// A body keeps its tone for a run, as it keeps its key.
BlockTone tone_of(std::uint64_t body_key);

}  // namespace sunder::render
