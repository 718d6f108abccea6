// The procedural textures' raw material: small pictures of a metre or two of wall that repeat.
//
// They are baked once, on the processor, so that a fragment shader needs a texel instead of
// octaves of noise, and mip maps filter what is far away.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/table.h"

namespace sunder::render {

/// The layers of the tile array, in order.
enum class Tile : std::uint8_t {
  kGrain,     ///< Fine even grain.
  kBrick,     ///< Running bond, 24 x 7 cm bricks with joints.
  kConcrete,  ///< Stains and pits.
  kPlaster,   ///< Trowel strokes.
  kWood,      ///< Boards along u.
  kRubble,    ///< Broken aggregate: stones in a matrix.
  kCloud,     ///< Large smooth variation, for weathering.
};
inline constexpr int kTiles = 7;
inline constexpr int kTileSize = 512;  ///< Texels a side.

/// How many metres of surface a tile shows.
inline constexpr float kTileMetres[kTiles] = {0.7f, 2, 2.7f, 1.9f, 1.2f, 0.8f, 7.3f};
/// Slopes (dz/du, dz/dv) are stored between −kSteepest and +kSteepest.
inline constexpr float kSteepest = 2;

/// RGBA8 texels of every layer, one after the other. Red: brightness, 0.5 is neutral. Green: how
/// much of the second colour (joints, pits, stones). Blue, alpha: slope along u and v.
std::vector<std::uint8_t> bake_tiles();

/// As the texture of the unit that is current.
void upload_tiles(const GlTable& gl);

}  // namespace sunder::render
