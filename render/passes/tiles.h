// Tiles: periodic images from which the procedural textures are composed, of 0.7 m to 7.3 m.
//
// They are baked once on the CPU, so that a fragment shader reads a texel in place of octaves of
// noise, and mip maps filter distant surfaces.
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
inline constexpr int kTileSize = 512;  ///< Width and height of a tile, in texels.

/// Size of a tile on a surface, in m.
inline constexpr float kTileMetres[kTiles] = {0.7f, 2, 2.7f, 1.9f, 1.2f, 0.8f, 7.3f};
/// Slopes (dz/du, dz/dv) are stored from −kMaxSlope to +kMaxSlope.
inline constexpr float kMaxSlope = 2;

/// Returns the RGBA8 texels of every layer in order. Red: brightness, 0.5 is neutral. Green: share
/// of the second colour (joints, pits, stones). Blue, alpha: slope along u and v.
std::vector<std::uint8_t> bake_tiles();

/// Uploads the tiles as the texture of the active unit.
void upload_tiles(const GlTable& gl);

}  // namespace sunder::render
