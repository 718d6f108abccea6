// The passes that make an image. Read first: Renderer::draw().
#include "render/renderer.h"

#include <cmath>
#include <ctime>
#include <optional>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "render/frame_interpolation.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/units.h"
#include "render/image/antialias.h"
#include "render/image/hud.h"
#include "render/options.h"
#include "render/passes/chips.h"
#include "render/passes/layers.h"
#include "render/passes/marks.h"
#include "render/passes/material_rows.h"
#include "render/passes/pictures.h"
#include "render/passes/pieces.h"
#include "render/passes/programs.h"
#include "render/passes/puffs.h"
#include "render/passes/tiles.h"
#include "render/passes/viewpoint.h"
#include "render/view_mode.h"

namespace sunder::render {
namespace {

struct Target {
  GLuint framebuffer = 0;
  int width = 0;
  int height = 0;
};

/// Makes a texture unit active: textures bound from here on are bound to it.
void activate_unit(const GlTable& gl, Unit unit) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
}

/// Makes a target with a texture that stays bound to its own unit.
Target make_target(const GlTable& gl, Unit unit, GLenum format, int width, int height,
                   GLuint depth = 0) {
  activate_unit(gl, unit);
  const GLuint texture = make_texture(gl, format, width, height);
  return {make_framebuffer(gl, texture, depth), width, height};
}

Target make_shadow_target(const GlTable& gl, Unit unit, int texels) {
  activate_unit(gl, unit);
  const GLuint texture = make_shadow_texture(gl, texels);
  return {make_framebuffer(gl, 0, texture), texels, texels};
}

/// Returns the offset of a sample from the pixel's centre, by the R2 sequence (Roberts 2018).
Vec2 jitter_of(int sample) {
  const auto of = [&](double step) {
    const double x = 0.5 + step * sample;
    return x - std::floor(x) - 0.5;
  };
  return {of(0.7548776662466927), of(0.5698402909980532)};
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const RenderOptions& wanted);

  void draw_light(const Frame& frame, const Sample& sample);
  void upload(const Frame& frame, const Sample& sample);
  void draw_shadows();
  void draw_pieces();
  void draw_ground_and_sky();
  void draw_occlusion();
  void draw_glass();
  void draw_dust();
  void draw_marks();
  void composite();
  void gather(bool first);
  void develop();
  Image read_back();

  bool gathers() const { return options.samples > 1 || options.transparent; }
  void begin_pass(const Target& target, GLuint program);
  /// Ends a pass; records its time if options.time_passes is set.
  void end_pass(const char* pass);

  RenderOptions options;
  ViewMode view_mode;
  std::unique_ptr<GlContext> context;
  const GlTable& gl;
  Programs programs;
  Pieces pieces;
  DepthTiles depth_tiles;
  Chips chips;
  Puffs puffs;
  std::optional<Pictures> pictures;
  std::optional<Layers> layers;  ///< Empty if the options name no layers.
  std::vector<Layer> drawn_layers;
  std::optional<Marks> marks;  ///< Empty if the view mode has no marks.
  FrameUniforms uniforms = {};
  GLuint uniform_buffer = 0;
  GLuint material_buffer = 0;
  GLuint empty_vertex_array = 0;  ///< Vertex array of passes without vertex data.
  Target shadow;
  Target zenith;
  Target light;
  Target open;
  Target blurred;
  Target dust;
  Target sum;  ///< Sum of the samples.
  Target picture;
  std::shared_ptr<const std::vector<Material>> materials;
  std::shared_ptr<const std::vector<Appearance>> appearances;
  std::vector<std::uint32_t> pixels;
  std::vector<PassTime> times;
  Stopwatch watch;
  std::clock_t cpu_start = 0;
};

Renderer::Impl::Impl(const RenderOptions& wanted)
    : options(checked_options(wanted)),
      view_mode(wanted.view_mode),
      context(make_context(wanted.gl)),
      gl(context->gl()),
      programs(make_programs(gl, wanted.samples > 1 || wanted.transparent, wanted.transparent)),
      pieces(gl),
      depth_tiles(gl),
      chips(gl),
      puffs(gl) {
  if (view_mode.needs_inspection()) marks.emplace(gl);
  const int w = options.width;
  const int h = options.height;
  const int half_w = (w + 1) / 2;
  const int half_h = (h + 1) / 2;
  // Targets that are only read back need no unit of their own: others are bound over them.
  if (!options.layers.empty()) layers.emplace(gl, options.layers, w, h);
  picture = {make_framebuffer(gl, make_texture(gl, GL_RGBA8, w, h), 0), w, h};
  shadow = make_shadow_target(gl, kShadowUnit, kShadowTexels);
  zenith = make_shadow_target(gl, kZenithUnit, kZenithTexels);
  activate_unit(gl, kDepthUnit);
  const GLuint depth = make_texture(gl, GL_DEPTH_COMPONENT24, w, h);
  light = make_target(gl, kLightUnit, GL_RGBA16F, w, h, depth);
  open = make_target(gl, kOpenUnit, GL_RG16F, half_w, half_h);
  blurred = make_target(gl, kBlurUnit, GL_RG16F, half_w, half_h);
  dust = make_target(gl, kDustUnit, GL_RGBA16F, half_w, half_h);
  if (gathers()) sum = make_target(gl, kSumUnit, GL_RGBA32F, w, h);
  pixels.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));

  activate_unit(gl, kTileUnit);
  upload_tiles(gl);
  activate_unit(gl, kPictureUnit);
  pictures.emplace(gl);
  activate_unit(gl, kSlotUnit);
  gl.BindTexture(GL_TEXTURE_BUFFER, pieces.slot_texture());
  GLuint look_texture = 0;
  gl.GenTextures(1, &look_texture);
  gl.GenBuffers(1, &material_buffer);
  activate_unit(gl, kMaterialUnit);
  gl.BindBuffer(GL_TEXTURE_BUFFER, material_buffer);
  gl.BindTexture(GL_TEXTURE_BUFFER, look_texture);
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, material_buffer);
  gl.GenBuffers(1, &uniform_buffer);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, uniform_buffer);
  gl.GenVertexArrays(1, &empty_vertex_array);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  SUNDER_CHECK(gl.GetError() == GL_NO_ERROR);
}

void Renderer::Impl::begin_pass(const Target& target, GLuint program) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl.Viewport(0, 0, target.width, target.height);
  gl.UseProgram(program);
}

void Renderer::Impl::end_pass(const char* pass) {
  if (!options.time_passes) return;
  gl.Finish();
  const std::clock_t now = std::clock();
  times.push_back(
      {pass, watch.lap_ms(), 1e3 * static_cast<double>(now - cpu_start) / CLOCKS_PER_SEC});
  cpu_start = now;
}

void Renderer::Impl::upload(const Frame& frame, const Sample& sample) {
  activate_unit(gl, kSlotUnit);
  pieces.update(frame);
  if (frame.appearances != appearances) {
    appearances = frame.appearances;
    activate_unit(gl, kPictureUnit);
    pictures->update(appearances ? *appearances : std::vector<Appearance>());
    materials = nullptr;  // forces the upload of all rows: those of appearances follow
  }
  if (frame.materials != materials) {
    materials = frame.materials;
    std::vector<float> rows = material_rows(*materials);
    if (appearances) {
      const std::vector<float> more = pictures->rows(*appearances);
      rows.insert(rows.end(), more.begin(), more.end());
    }
    fill_buffer(gl, GL_TEXTURE_BUFFER, material_buffer, rows, GL_STATIC_DRAW);
  }
  uniforms = make_uniforms(frame.view, pieces.casters(), options.width, options.height, sample);
  uniforms.ground_offset[2] = static_cast<float>(kTexelsPerMaterial * materials->size());
  gl.BindBuffer(GL_UNIFORM_BUFFER, uniform_buffer);
  gl.BufferData(GL_UNIFORM_BUFFER, sizeof uniforms, &uniforms, GL_STREAM_DRAW);
  chips.update(frame, uniforms.lens[1], uniforms.to_sun[3]);
  puffs.update(frame);
  if (marks) marks->update(view_mode.marks(), frame.view.eye_W);
}

void Renderer::Impl::draw_shadows() {
  gl.Enable(GL_DEPTH_TEST);
  gl.Enable(GL_CULL_FACE);
  gl.CullFace(GL_BACK);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 2);
  begin_pass(shadow, programs.shadow);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  depth_tiles.start(view_of_light(uniforms.shadow_of_eye, kShadowTexels));
  pieces.draw_shadows(depth_tiles);
  chips.draw_shadows();
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  end_pass("shadows");
  begin_pass(zenith, programs.zenith);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  depth_tiles.start(view_of_light(uniforms.zenith_of_eye, kZenithTexels));
  pieces.draw_heights(depth_tiles);
  end_pass("zenith");
}

void Renderer::Impl::draw_pieces() {
  begin_pass(light, programs.matte);
  gl.ClearColor(0, 0, 0, 1);  // alpha 1: everything behind shows through
  gl.Clear(GL_DEPTH_BUFFER_BIT | (options.transparent ? GL_COLOR_BUFFER_BIT : 0u));
  gl.PolygonMode(GL_FRONT_AND_BACK, view_mode.edges() ? GL_LINE : GL_FILL);
  depth_tiles.start(view_of_camera(uniforms.clip_of_eye, options.width, options.height));
  using Group = Pieces::Group;
  for (const auto& [group, program] :
       {std::pair(Group::kMatte, programs.matte), std::pair(Group::kTextured, programs.textured),
        std::pair(Group::kBlocks, programs.blocks), std::pair(Group::kShiny, programs.shiny)}) {
    if (!pieces.has(group)) continue;
    begin_pass(light, program);
    pieces.draw(group, depth_tiles);
  }
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  chips.draw();
}

void Renderer::Impl::draw_ground_and_sky() {
  gl.Disable(GL_CULL_FACE);
  gl.BindVertexArray(empty_vertex_array);
  begin_pass(light, programs.ground);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  begin_pass(light, programs.sky);
  gl.DepthFunc(GL_LEQUAL);
  gl.DepthMask(GL_FALSE);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_LESS);
}

void Renderer::Impl::draw_occlusion() {
  gl.Disable(GL_DEPTH_TEST);
  gl.BindVertexArray(empty_vertex_array);
  begin_pass(open, programs.occlusion);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  begin_pass(blurred, programs.blur);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.Enable(GL_DEPTH_TEST);
}

void Renderer::Impl::draw_glass() {
  begin_pass(light, programs.glass);
  gl.Enable(GL_CULL_FACE);
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ZERO, GL_SRC1_ALPHA);
  gl.DepthMask(GL_FALSE);
  pieces.draw(Pieces::Group::kGlass);
  if (!gathers() && !view_mode.edges()) {
    begin_pass(light, programs.glass_lines);
    gl.PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    pieces.draw(Pieces::Group::kGlass);
    gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  }
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.CullFace(GL_BACK);
}

void Renderer::Impl::draw_dust() {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  begin_pass(dust, 0);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  puffs.draw();
  gl.Disable(GL_BLEND);
}

void Renderer::Impl::draw_marks() {
  begin_pass(light, 0);
  marks->draw();
}

void Renderer::Impl::composite() {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.BindVertexArray(empty_vertex_array);
  begin_pass(picture, puffs.any() ? programs.dusty : programs.composite);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

/// Adds the sample drawn to the sum.
void Renderer::Impl::gather(bool first) {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.BindVertexArray(empty_vertex_array);
  begin_pass(sum, puffs.any() ? programs.dusty_gather : programs.gather);
  gl.ClearColor(0, 0, 0, 0);
  if (first) gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.Disable(GL_BLEND);
}

void Renderer::Impl::develop() {
  begin_pass(picture, programs.develop);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

Image Renderer::Impl::read_back() {
  gl.ReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  end_pass("read");
  Image image = gathers() ? unpacked(pixels, options.width, options.height, options.transparent)
                          : apply_fxaa(pixels, options.width, options.height);
  end_pass("antialias");
  return image;
}

void Renderer::Impl::draw_light(const Frame& frame, const Sample& sample) {
  upload(view_mode.shown(frame), sample);
  end_pass("upload");
  draw_shadows();
  draw_pieces();
  end_pass("pieces");
  if (!options.transparent) draw_ground_and_sky();
  end_pass("ground and sky");
  draw_occlusion();
  end_pass("occlusion");
  if (pieces.has(Pieces::Group::kGlass)) draw_glass();
  end_pass("glass");
  if (puffs.any()) draw_dust();
  end_pass("dust");
  if (marks && marks->any()) draw_marks();
}

Renderer::Renderer(const RenderOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

Image Renderer::draw(const Frame& frame, const Frame* before) {
  Impl& r = *impl_;
  r.context->make_current();
  r.times.clear();
  r.watch.lap_ms();
  r.cpu_start = std::clock();
  if (!r.gathers()) {
    r.draw_light(frame, {});
    r.composite();
  } else {
    const double weight = 1.0 / r.options.samples;
    const bool blurs = frame.view.shutter > 0;
    const FrameInterval interval = blurs ? up_to(frame, before) : FrameInterval{};
    for (int s = 0; s < r.options.samples; ++s) {
      const double part = 1 - frame.view.shutter * (1 - (s + 0.5) * weight);
      r.draw_light(blurs ? *between(interval, part) : frame, {jitter_of(s), weight});
      r.gather(s == 0);
    }
    r.develop();
  }
  r.end_pass("composite");
  Image image = r.read_back();
  if (r.layers) {
    const Frame& shown = r.view_mode.shown(frame);
    if (r.options.samples > 1) r.upload(shown, {});  // the frame itself, not the last sample
    r.drawn_layers = r.layers->draw(shown, r.pieces, r.chips);
  }
  if (r.options.hud) draw_text(image, hud_text(frame));
  SUNDER_CHECK(r.gl.GetError() == GL_NO_ERROR);
  return image;
}

std::string Renderer::description() const { return impl_->context->description(); }
std::vector<std::string> Renderer::warnings() const { return impl_->pictures->warnings(); }
const std::vector<Layer>& Renderer::layers() const { return impl_->drawn_layers; }
const RenderOptions& Renderer::options() const { return impl_->options; }
int Renderer::width() const { return impl_->options.width; }
int Renderer::height() const { return impl_->options.height; }
const std::vector<PassTime>& Renderer::pass_times() const { return impl_->times; }

}  // namespace sunder::render
