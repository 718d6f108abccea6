// Which texture unit holds what: each texture stays on its own for good.
#pragma once

namespace sunder::render {

enum Unit {
  kShadowUnit,
  kZenithUnit,
  kSlotUnit,
  kMaterialUnit,
  kTileUnit,
  kDepthUnit,
  kLightUnit,
  kOpenUnit,
  kBlurUnit,
  kDustUnit
};

}  // namespace sunder::render
