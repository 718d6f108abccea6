// The programs of the passes, but for those of particles and marks, which have their own.
#pragma once

#include "render/gl/table.h"

namespace sunder::render {

struct Programs {
  GLuint shadow, zenith, matte, painted, blocks, shiny, glass, ground, sky, occlusion, blur;
  GLuint composite, dusty;               ///< Light to picture; with dust.
  GLuint gather, dusty_gather, develop;  ///< To a sum, and that to picture; 0 unless asked for.
};

/// `gathers`: pictures are sums; with `transparent`, of what covers them.
Programs make_programs(const GlTable& gl, bool gathers, bool transparent);

}  // namespace sunder::render
