// GL programs of the passes, except those of particles and marks.
#pragma once

#include "render/gl/table.h"

namespace sunder::render {

struct Programs {
  GLuint shadow, zenith, matte, textured, blocks, shiny, glass, glass_lines, ground, sky, occlusion,
      blur;
  GLuint composite, dusty;               ///< From light to image; with dust.
  GLuint gather, dusty_gather, develop;  ///< From light to a sum, from the sum to an image; or 0.
};

/// Makes the programs; with `gathers` also those for images that are sums of samples, with
/// `transparent` with alpha as coverage.
Programs make_programs(const GlTable& gl, bool gathers, bool transparent);

}  // namespace sunder::render
