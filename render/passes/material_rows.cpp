#include "render/passes/material_rows.h"

#include "render/passes/tiles.h"

namespace sunder::render {
namespace {

constexpr float kNoPlaster = 9;  ///< A value that the weathering noise never reaches.
/// Value of the weathering noise, 0 to 1, above which plaster is left on a brick wall.
constexpr float kPlasterFrom = 0.58f;

struct Finish {
  Tile tile = Tile::kGrain;
  Vec3f second = Vec3f::Zero();     ///< Linear colour of joints, pits or stones.
  float bump = 1;                   ///< Factor of the slopes of the tile.
  float contrast = 1.4f;            ///< Factor of the brightness variation of the tile.
  float plaster_from = kNoPlaster;  ///< Value of the weathering noise from which there is plaster.
  float chips = 1;                  ///< Brightness factor of debris.
};

Finish surface_finish(const Look& look) {
  switch (look.texture) {
    case Texture::kBrick:
      return {Tile::kBrick, Vec3f(0.46f, 0.43f, 0.38f), 0.9f, 1.7f, kPlasterFrom};
    case Texture::kConcrete:
      return {Tile::kConcrete, 0.45f * look.color, 1, 1.2f};
    case Texture::kPlaster:
      return {Tile::kPlaster, look.color, 0.9f, 1.3f};
    case Texture::kWood:
      return {Tile::kWood, 0.25f * look.color, 1, 1.7f};
    case Texture::kMetal:
      return {Tile::kGrain, look.color, 0.25f, 0.8f};
    case Texture::kGlass:
      return {Tile::kGrain, look.color, 0, 1};  // glass.frag knows clear faces by bump = 0
    case Texture::kPlain:
      return {Tile::kGrain, look.color, 1, 1.2f};
  }
  return {};
}

/// Returns the finish of a broken face: rougher, with the interior of the material visible.
Finish interior_finish(const Look& look) {
  switch (look.texture) {
    case Texture::kBrick:
      return {Tile::kRubble, 0.9f * look.color + Vec3f::Constant(0.05f), 0.7f, 1.4f};
    case Texture::kWood:
      return {Tile::kWood, 0.7f * look.color, 2, 1.9f};
    case Texture::kMetal:
      return {Tile::kGrain, look.color, 1.5f, 1.5f};
    case Texture::kGlass:
      return {Tile::kGrain, look.color, 1, 1, kNoPlaster, 0.45f};
    default:
      return {Tile::kRubble, 0.72f * look.color + Vec3f(0.03f, 0.03f, 0.03f), 1.1f, 1.6f};
  }
}

void append(std::vector<float>& texels, const Look& look, const Finish& finish) {
  const auto tile = static_cast<std::size_t>(finish.tile);
  texels.insert(texels.end(),
                {look.color.x(), look.color.y(), look.color.z(),           //
                 1 / kTileMetres[tile],                                    //
                 finish.second.x(), finish.second.y(), finish.second.z(),  //
                 finish.plaster_from,                                      //
                 static_cast<float>(tile), finish.bump, finish.contrast, finish.chips});
}

}  // namespace

std::vector<float> material_rows(std::span<const Material> materials) {
  std::vector<float> texels;
  texels.reserve(4 * kTexelsPerMaterial * materials.size());
  for (const Material& material : materials) {
    append(texels, material.surface, surface_finish(material.surface));
    append(texels, material.interior, interior_finish(material.interior));
  }
  return texels;
}

}  // namespace sunder::render
