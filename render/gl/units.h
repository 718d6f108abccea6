// Which texture unit holds what: each texture stays on its own for good, and shaders call what
// reads it by one name.
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

/// The samplers of unit 0, 1 and so on.
inline constexpr const char* kSamplers[] = {"shadow_map", "zenith_map", "slots",  "materials",
                                            "tiles",      "pictures",   "depths", "lights",
                                            "openness",   "occlusion",  "dust",   "sums"};

}  // namespace sunder::render
