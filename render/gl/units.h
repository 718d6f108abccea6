// Texture units. A texture stays bound to its unit; its sampler has one name in all shaders.
#pragma once

namespace sunder::render {

enum Unit {
  kShadowUnit,
  kZenithUnit,
  kSlotUnit,
  kMaterialUnit,
  kTileUnit,
  kPictureUnit,
  kDepthUnit,
  kLightUnit,
  kOpenUnit,
  kBlurUnit,
  kDustUnit,
  kSumUnit
};

/// Sampler names of units 0, 1 and so on, in the order of Unit.
inline constexpr const char* kSamplers[] = {"shadow_map", "zenith_map", "slots",  "materials",
                                            "tiles",      "pictures",   "depths", "lights",
                                            "openness",   "occlusion",  "dust",   "sums"};

}  // namespace sunder::render
