#include "render/passes/layers.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "engine/base/check.h"
#include "render/passes/viewpoint.h"
#include "render/shaders/shader_sources.h"

namespace sunder::render {
namespace {

struct Kind {
  const char* name;
  const char* define;
  int channels;
  const char* meaning;
};
constexpr std::array<Kind, 3> kKinds = {{
    {"depth", "#define DEPTH\n", 1, "metres along the view: value / 65535 * far_m; 65535: or more"},
    {"normals", "#define NORMALS\n", 3,
     "out of the surface, in the world: value / 32767.5 - 1; 0, 0, 0: nothing is there"},
    {"ids", "#define IDS\n", 3,
     "red + 65536 green: the key of a body, and 1; 0: none, as the ground, debris and the sky"},
}};

const Kind& kind_of(const std::string& name) {
  const auto found = std::ranges::find(kKinds, name, &Kind::name);
  if (found == kKinds.end())
    throw InputError("--also " + name + ": expected " + kLayers + ", or several, with commas");
  return *found;
}

}  // namespace

void check_layers(std::span<const std::string> names) {
  for (const std::string& name : names) kind_of(name);
}

Layers::Layers(const GlTable& gl, const std::vector<std::string>& names, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  using namespace shader_sources;
  framebuffer_ = make_framebuffer(gl, make_texture(gl, GL_RGBA16, width, height),
                                  make_texture(gl, GL_DEPTH_COMPONENT24, width, height));
  gl_.GenVertexArrays(1, &empty_vertex_array_);
  for (const std::string& name : names) {
    const char* const define = kind_of(name).define;
    const auto made = [&](const char* what, std::initializer_list<const char*> vertex) {
      return make_program(gl, what, vertex, {common_glsl, define, layer_frag});
    };
    passes_.push_back({name,
                       made("layer", {common_glsl, bodies_glsl, "#define PIECES\n", layer_vert}),
                       made("layer of chips", {common_glsl, "#define LAYER\n", chips_vert}),
                       made("layer of the ground", {common_glsl, "#define GROUND\n", layer_vert})});
  }
}

std::vector<Layer> Layers::draw(const Frame& frame, Pieces& pieces, const Chips& chips) {
  std::vector<Layer> layers;
  pieces.name_bodies(frame);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
  gl_.Enable(GL_DEPTH_TEST);
  for (const Pass& pass : passes_) {
    const Kind& kind = kind_of(pass.name);
    const float none = pass.name == "depth" ? 1.f : 0.f;
    gl_.ClearColor(none, none, none, none);
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(GL_BACK);
    gl_.UseProgram(pass.pieces);
    for (const auto group : {Pieces::Group::kOpaque, Pieces::Group::kGlass}) pieces.draw(group);
    chips.draw(pass.chips);
    gl_.Disable(GL_CULL_FACE);
    gl_.UseProgram(pass.ground);
    gl_.BindVertexArray(empty_vertex_array_);
    gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    layers.push_back({pass.name, read(kind.channels)});
    layers.back().image.words = {{"Description", kind.meaning}};
    if (pass.name != "depth") continue;
    std::array<char, 32> far;
    std::snprintf(far.data(), far.size(), "%.9g", depth_end_m(frame.view));
    layers.back().image.words.emplace_back("near_m", "0");
    layers.back().image.words.emplace_back("far_m", far.data());
  }
  return layers;
}

DeepImage Layers::read(int channels) const {
  const auto columns = static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_);
  std::vector<std::uint16_t> pixels(4 * columns * rows);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_SHORT, pixels.data());
  DeepImage image{width_, height_, channels, {}, {}};
  for (std::size_t row = rows; row-- > 0;) {
    for (std::size_t x = 0; x < columns; ++x) {
      for (int c = 0; c < channels; ++c)
        image.values.push_back(pixels[4 * (row * columns + x) + static_cast<std::size_t>(c)]);
    }
  }
  return image;
}

}  // namespace sunder::render
