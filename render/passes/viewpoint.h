// Matrices of camera and sun; the only conversion from the world in double to eye space in float.
#pragma once

#include <span>

#include "engine/model/frame.h"

namespace sunder::render {

/// The uniform block `Frame` of shaders/common.glsl; std140.
struct FrameUniforms {
  float clip_of_eye[16];
  float shadow_of_eye[16];
  float zenith_of_eye[16];
  float ray_right[4];
  float ray_up[4];
  float ray_forward[4];
  float to_sun[4];
  float ground[4];
  float ground_offset[4];
  float pixel[4];
  float lens[4];
  float sun_light[4];
  float sky_light[4];
  float zenith[4];
  float horizon[4];
  float cloud_light[4];
  float sun_glow[4];
};

inline constexpr int kShadowTexels = 2048;
inline constexpr int kZenithTexels = 512;

/// Bounding sphere of a shadow caster, relative to the eye.
struct Caster {
  Vec3f center;
  float radius;
};

/// One of the samples that an image is the mean of.
struct Sample {
  Vec2 jitter_px = Vec2::Zero();  ///< Offset from the centre of a pixel: right and up.
  double weight = 1;
};

/// Returns the uniforms of a frame. The shadow map covers the casters near the view's target whose
/// shadows are visible; its size and place change in steps, so that shadows do not shimmer while
/// the casters move.
FrameUniforms make_uniforms(const View& view, std::span<const Caster> casters, int width,
                            int height, const Sample& sample = {});

}  // namespace sunder::render
