// The list of passes that make a picture. Read first: Renderer::draw().
#include "render/renderer.h"

#include <ctime>
#include <optional>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/units.h"
#include "render/image/antialias.h"
#include "render/image/hud.h"
#include "render/passes/chips.h"
#include "render/passes/marks.h"
#include "render/passes/material_rows.h"
#include "render/passes/pictures.h"
#include "render/passes/pieces.h"
#include "render/passes/puffs.h"
#include "render/passes/tiles.h"
#include "render/passes/viewpoint.h"
#include "render/shaders/shader_sources.h"
#include "render/view_mode.h"

namespace sunder::render {
namespace {

struct Programs {
  GLuint shadow, zenith, matte, painted, shiny, glass, ground, sky, occlusion, blur, composite,
      dusty;
};

struct Target {
  GLuint framebuffer = 0;
  int width = 0;
  int height = 0;
};

Programs make_programs(const GlTable& gl) {
  using namespace shader_sources;
  Programs p;
  p.shadow = make_program(gl, "shadow",
                          {common_glsl, bodies_glsl, "#define LIGHT shadow_of_eye\n", shadow_vert},
                          {common_glsl, nothing_frag});
  p.zenith = make_program(gl, "zenith",
                          {common_glsl, bodies_glsl, "#define LIGHT zenith_of_eye\n", shadow_vert},
                          {common_glsl, nothing_frag});
  p.matte = make_program(gl, "matte", {common_glsl, bodies_glsl, pieces_vert},
                         {common_glsl, shadow_glsl, pieces_frag});
  p.painted =
      make_program(gl, "painted", {common_glsl, bodies_glsl, "#define PAINTED\n", pieces_vert},
                   {common_glsl, shadow_glsl, "#define PAINTED\n", pieces_frag});
  p.shiny = make_program(gl, "shiny", {common_glsl, bodies_glsl, pieces_vert},
                         {common_glsl, shadow_glsl, "#define SHINY\n", pieces_frag});
  p.glass = make_program(gl, "glass", {common_glsl, bodies_glsl, pieces_vert},
                         {common_glsl, shadow_glsl, glass_frag});
  p.ground = make_program(gl, "ground", {common_glsl, ground_vert},
                          {common_glsl, shadow_glsl, ground_frag});
  p.sky = make_program(gl, "sky", {common_glsl, screen_vert}, {common_glsl, sky_frag});
  p.occlusion =
      make_program(gl, "occlusion", {common_glsl, screen_vert}, {common_glsl, occlusion_frag});
  p.blur = make_program(gl, "blur", {common_glsl, screen_vert}, {common_glsl, blur_frag});
  p.composite =
      make_program(gl, "composite", {common_glsl, screen_vert}, {common_glsl, composite_frag});
  p.dusty = make_program(gl, "dusty composite", {common_glsl, screen_vert},
                         {common_glsl, "#define DUSTY\n", composite_frag});
  return p;
}

/// What is bound from here on is on that unit, and stays there.
void take_unit(const GlTable& gl, Unit unit) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
}

/// To draw into, and then to read on a unit of its own.
Target make_target(const GlTable& gl, Unit unit, GLenum format, int width, int height,
                   GLuint depth = 0) {
  take_unit(gl, unit);
  const GLuint texture = make_texture(gl, format, width, height);
  return {make_framebuffer(gl, texture, depth), width, height};
}

Target make_shadow_target(const GlTable& gl, Unit unit, int texels) {
  take_unit(gl, unit);
  const GLuint texture = make_shadow_texture(gl, texels);
  return {make_framebuffer(gl, 0, texture), texels, texels};
}

void upload_tiles(const GlTable& gl) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  take_unit(gl, kTileUnit);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  const std::vector<std::uint8_t> texels = bake_tiles();
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, kTileSize, kTileSize, kTiles, 0, GL_RGBA,
                GL_UNSIGNED_BYTE, texels.data());
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.GenerateMipmap(GL_TEXTURE_2D_ARRAY);
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const RenderOptions& wanted);

  void upload(const Frame& frame);
  void draw_shadows();
  void draw_pieces();
  void draw_ground_and_sky();
  void draw_occlusion();
  void draw_glass();
  void draw_dust();
  void draw_marks();
  void composite();
  Image read_back();

  void begin(const Target& target, GLuint program);
  /// Ends a pass, and times it if that was asked for.
  void done(const char* pass);

  RenderOptions options;
  ViewMode view_mode;
  std::unique_ptr<GlContext> context;
  const GlTable& gl;
  Programs programs;
  Pieces pieces;
  Chips chips;
  Puffs puffs;
  std::optional<Pictures> pictures;
  Marks marks;
  GLuint uniform_buffer = 0;
  GLuint material_buffer = 0;
  GLuint empty_vertex_array = 0;  ///< For passes that need no vertices.
  Target shadow;
  Target zenith;
  Target light;
  Target open;
  Target blurred;
  Target dust;
  Target picture;
  std::shared_ptr<const std::vector<Material>> materials;
  std::shared_ptr<const std::vector<Paint>> paints;
  std::vector<std::uint32_t> pixels;
  std::vector<PassTime> times;
  Stopwatch watch;
  std::clock_t cpu_start = 0;
};

Renderer::Impl::Impl(const RenderOptions& wanted)
    : options(wanted),
      view_mode(wanted.view_mode),
      context(make_context(wanted.gl)),
      gl(context->gl()),
      programs(make_programs(gl)),
      pieces(gl),
      chips(gl),
      puffs(gl),
      marks(gl) {
  const int w = options.width;
  const int h = options.height;
  const int half_w = (w + 1) / 2;
  const int half_h = (h + 1) / 2;
  picture = {make_framebuffer(gl, make_texture(gl, GL_RGBA8, w, h), 0), w, h};
  shadow = make_shadow_target(gl, kShadowUnit, kShadowTexels);
  zenith = make_shadow_target(gl, kZenithUnit, kZenithTexels);
  take_unit(gl, kDepthUnit);
  const GLuint depth = make_texture(gl, GL_DEPTH_COMPONENT24, w, h);
  light = make_target(gl, kLightUnit, GL_RGBA16F, w, h, depth);
  open = make_target(gl, kOpenUnit, GL_RG16F, half_w, half_h);
  blurred = make_target(gl, kBlurUnit, GL_RG16F, half_w, half_h);
  dust = make_target(gl, kDustUnit, GL_RGBA16F, half_w, half_h);
  pixels.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));

  upload_tiles(gl);
  take_unit(gl, kPictureUnit);
  pictures.emplace(gl);
  take_unit(gl, kSlotUnit);
  gl.BindTexture(GL_TEXTURE_BUFFER, pieces.slot_texture());
  GLuint look_texture = 0;
  gl.GenTextures(1, &look_texture);
  gl.GenBuffers(1, &material_buffer);
  take_unit(gl, kMaterialUnit);
  gl.BindBuffer(GL_TEXTURE_BUFFER, material_buffer);
  gl.BindTexture(GL_TEXTURE_BUFFER, look_texture);
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, material_buffer);
  gl.GenBuffers(1, &uniform_buffer);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, uniform_buffer);
  gl.GenVertexArrays(1, &empty_vertex_array);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  SUNDER_CHECK(gl.GetError() == GL_NO_ERROR);
}

void Renderer::Impl::begin(const Target& target, GLuint program) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl.Viewport(0, 0, target.width, target.height);
  gl.UseProgram(program);
}

void Renderer::Impl::done(const char* pass) {
  if (!options.time_passes) return;
  gl.Finish();
  const std::clock_t now = std::clock();
  times.push_back(
      {pass, watch.lap_ms(), 1e3 * static_cast<double>(now - cpu_start) / CLOCKS_PER_SEC});
  cpu_start = now;
}

void Renderer::Impl::upload(const Frame& frame) {
  take_unit(gl, kSlotUnit);
  pieces.update(frame);
  if (frame.paints != paints) {
    paints = frame.paints;
    take_unit(gl, kPictureUnit);
    pictures->update(paints ? *paints : std::vector<Paint>());
    materials = nullptr;  // whose rows come before those of paints
  }
  if (frame.materials != materials) {
    materials = frame.materials;
    std::vector<float> rows = material_rows(*materials);
    if (paints) {
      const std::vector<float> more = pictures->rows(*paints);
      rows.insert(rows.end(), more.begin(), more.end());
    }
    fill_buffer(gl, GL_TEXTURE_BUFFER, material_buffer, rows, GL_STATIC_DRAW);
  }
  FrameUniforms uniforms =
      make_uniforms(frame.view, pieces.casters(), options.width, options.height);
  uniforms.lens[2] = static_cast<float>(kTexelsAMaterial * materials->size());
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniform_buffer);
  gl.BufferData(GL_UNIFORM_BUFFER, sizeof uniforms, &uniforms, GL_STREAM_DRAW);
  chips.update(frame, uniforms.lens[1], uniforms.to_sun[3]);
  puffs.update(frame);
  marks.update(view_mode.marks(), frame.view.eye_W);
}

void Renderer::Impl::draw_shadows() {
  gl.Enable(GL_DEPTH_TEST);
  gl.Enable(GL_CULL_FACE);
  gl.CullFace(GL_BACK);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2);
  begin(shadow, programs.shadow);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  pieces.draw(Pieces::Group::kMatte);
  pieces.draw(Pieces::Group::kPainted);
  pieces.draw(Pieces::Group::kShiny);
  chips.draw_shadows();
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  done("shadows");
  begin(zenith, programs.zenith);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  pieces.draw(Pieces::Group::kLarge);
  done("zenith");
}

void Renderer::Impl::draw_pieces() {
  begin(light, programs.matte);
  gl.Clear(GL_DEPTH_BUFFER_BIT);  // every pixel's colour is written by a piece, ground or sky
  gl.PolygonMode(GL_FRONT_AND_BACK, view_mode.edges() ? GL_LINE : GL_FILL);
  pieces.draw(Pieces::Group::kMatte);
  if (pieces.has(Pieces::Group::kPainted)) {
    begin(light, programs.painted);
    pieces.draw(Pieces::Group::kPainted);
  }
  begin(light, programs.shiny);
  pieces.draw(Pieces::Group::kShiny);
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  chips.draw();
}

void Renderer::Impl::draw_ground_and_sky() {
  gl.Disable(GL_CULL_FACE);
  gl.BindVertexArray(empty_vertex_array);
  begin(light, programs.ground);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  begin(light, programs.sky);
  gl.DepthFunc(GL_LEQUAL);
  gl.DepthMask(GL_FALSE);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_LESS);
}

void Renderer::Impl::draw_occlusion() {
  gl.Disable(GL_DEPTH_TEST);
  gl.BindVertexArray(empty_vertex_array);
  begin(open, programs.occlusion);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  begin(blurred, programs.blur);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.Enable(GL_DEPTH_TEST);
}

void Renderer::Impl::draw_glass() {
  begin(light, programs.glass);
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ZERO, GL_SRC1_ALPHA);
  gl.DepthMask(GL_FALSE);
  pieces.draw(Pieces::Group::kGlass);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.CullFace(GL_BACK);
}

void Renderer::Impl::draw_dust() {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  begin(dust, 0);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  puffs.draw();
  gl.Disable(GL_BLEND);
}

void Renderer::Impl::draw_marks() {
  begin(light, 0);
  marks.draw();
}

void Renderer::Impl::composite() {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.BindVertexArray(empty_vertex_array);
  begin(picture, puffs.any() ? programs.dusty : programs.composite);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

Image Renderer::Impl::read_back() {
  gl.ReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  done("read");
  Image image = antialiased(pixels, options.width, options.height);
  done("antialias");
  return image;
}

Renderer::Renderer(const RenderOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

Image Renderer::draw(const Frame& frame) {
  Impl& r = *impl_;
  r.context->make_current();
  r.times.clear();
  r.watch.lap_ms();
  r.cpu_start = std::clock();

  r.upload(r.view_mode.shown(frame));
  r.done("upload");
  r.draw_shadows();
  r.draw_pieces();
  r.done("pieces");
  r.draw_ground_and_sky();
  r.done("ground and sky");
  r.draw_occlusion();
  r.done("occlusion");
  if (r.pieces.has(Pieces::Group::kGlass)) r.draw_glass();
  r.done("glass");
  if (r.puffs.any()) r.draw_dust();
  r.done("dust");
  if (r.marks.any()) r.draw_marks();
  r.composite();
  r.done("composite");
  Image image = r.read_back();
  if (r.options.hud) draw_text(image, hud_text(frame));
  SUNDER_CHECK(r.gl.GetError() == GL_NO_ERROR);
  return image;
}

std::string Renderer::description() const { return impl_->context->description(); }
int Renderer::width() const { return impl_->options.width; }
int Renderer::height() const { return impl_->options.height; }
const std::vector<PassTime>& Renderer::pass_times() const { return impl_->times; }

}  // namespace sunder::render
