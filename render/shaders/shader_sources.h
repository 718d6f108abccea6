// The GLSL sources of this folder, embedded as strings (sunder_embed in cmake/Sunder.cmake).
#pragma once

namespace sunder::render::shader_sources {

extern const char* const common_glsl;
extern const char* const shadow_glsl;
extern const char* const bodies_glsl;
extern const char* const shadow_vert;
extern const char* const nothing_frag;
extern const char* const pieces_vert;
extern const char* const pieces_frag;
extern const char* const glass_frag;
extern const char* const ground_vert;
extern const char* const ground_frag;
extern const char* const screen_vert;
extern const char* const sky_frag;
extern const char* const occlusion_frag;
extern const char* const blur_frag;
extern const char* const tone_glsl;
extern const char* const composite_frag;
extern const char* const develop_frag;
extern const char* const chips_vert;
extern const char* const layer_vert;
extern const char* const layer_frag;
extern const char* const marks_vert;
extern const char* const marks_frag;
extern const char* const puffs_vert;
extern const char* const puffs_frag;

}  // namespace sunder::render::shader_sources
