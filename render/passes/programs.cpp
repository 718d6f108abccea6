#include "render/passes/programs.h"

#include "render/gl/objects.h"
#include "render/shaders/shader_sources.h"

namespace sunder::render {

Programs make_programs(const GlTable& gl, bool gathers, bool transparent) {
  using namespace shader_sources;
  Programs p = {};
  p.shadow = make_program(gl, "shadow",
                          {common_glsl, bodies_glsl, "#define LIGHT shadow_of_eye\n", shadow_vert},
                          {common_glsl, nothing_frag});
  p.zenith = make_program(gl, "zenith",
                          {common_glsl, bodies_glsl, "#define LIGHT zenith_of_eye\n", shadow_vert},
                          {common_glsl, nothing_frag});
  p.matte = make_program(gl, "matte", {common_glsl, bodies_glsl, pieces_vert},
                         {common_glsl, shadow_glsl, pieces_frag});
  p.textured =
      make_program(gl, "textured", {common_glsl, bodies_glsl, "#define TEXTURED\n", pieces_vert},
                   {common_glsl, shadow_glsl, "#define TEXTURED\n", pieces_frag});
  p.blocks = make_program(gl, "blocks", {common_glsl, bodies_glsl, "#define BLOCKS\n", pieces_vert},
                          {common_glsl, shadow_glsl, "#define BLOCKS\n", pieces_frag});
  p.shiny = make_program(gl, "shiny", {common_glsl, bodies_glsl, pieces_vert},
                         {common_glsl, shadow_glsl, "#define SHINY\n", pieces_frag});
  // Samples show thin faces by themselves.
  const char* const thin = gathers ? "" : "#define THIN_EDGES\n";
  p.glass = make_program(gl, "glass", {common_glsl, bodies_glsl, thin, pieces_vert},
                         {common_glsl, shadow_glsl, thin, glass_frag});
  p.glass_lines = make_program(gl, "glass_lines", {common_glsl, bodies_glsl, thin, pieces_vert},
                               {common_glsl, shadow_glsl, thin, "#define LINES\n", glass_frag});
  p.ground = make_program(gl, "ground", {common_glsl, ground_vert},
                          {common_glsl, shadow_glsl, ground_frag});
  p.sky = make_program(gl, "sky", {common_glsl, screen_vert}, {common_glsl, sky_frag});
  p.occlusion =
      make_program(gl, "occlusion", {common_glsl, screen_vert}, {common_glsl, occlusion_frag});
  p.blur = make_program(gl, "blur", {common_glsl, screen_vert}, {common_glsl, blur_frag});
  const auto to_picture = [&](const char* name, const char* defines) {
    return make_program(gl, name, {common_glsl, screen_vert},
                        {common_glsl, tone_glsl, defines, composite_frag});
  };
  p.composite = to_picture("composite", "");
  p.dusty = to_picture("dusty composite", "#define DUSTY\n");
  if (!gathers) return p;
  p.gather = to_picture("gather", "#define GATHER\n");
  p.dusty_gather = to_picture("dusty gather", "#define DUSTY\n#define GATHER\n");
  const char* const defines = transparent ? "#define TRANSPARENT\n" : "";
  p.develop = make_program(gl, "develop", {common_glsl, screen_vert},
                           {common_glsl, tone_glsl, defines, develop_frag});
  return p;
}

}  // namespace sunder::render
