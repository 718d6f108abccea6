#include "render/passes/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/base/check.h"
#include "render/passes/viewpoint.h"
#include "render/shaders/shader_sources.h"

namespace sunder::render {
namespace {

struct Kind {
  const char* name;
  const char* define;
  int channels;  ///< Number of channels; 0 for floats.
  const char* meaning;
};
constexpr std::array<Kind, 4> kKinds = {{
    {"depth", "#define DEPTH\n", 1, "metres along the view: value / 65535 * far_m; 65535: or more"},
    {"depth_m", "#define DEPTH\n", 0, ""},
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

bool is_depth(const std::string& name) { return name.starts_with("depth"); }

}  // namespace

void check_layers(std::span<const std::string> names) {
  for (const std::string& name : names) kind_of(name);
}

Layers::Layers(const GlTable& gl, const std::vector<std::string>& names, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  using namespace shader_sources;
  framebuffer_ = make_framebuffer(gl, make_texture(gl, GL_RGBA16, width, height),
                                  make_texture(gl, GL_DEPTH_COMPONENT24, width, height));
  if (std::ranges::any_of(names, is_depth)) {
    depth_framebuffer_ = make_framebuffer(gl, make_texture(gl, GL_R32F, width, height),
                                          make_texture(gl, GL_DEPTH_COMPONENT24, width, height));
  }
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
  pieces.write_body_ids(frame);
  gl_.Viewport(0, 0, width_, height_);
  gl_.Enable(GL_DEPTH_TEST);
  for (const Pass& pass : passes_) {
    draw(pass, pieces, chips);
    const Kind& kind = kind_of(pass.name);
    if (kind.channels == 0) {
      layers.push_back({pass.name, {}, read_metres()});
      continue;
    }
    layers.push_back(
        {pass.name, is_depth(pass.name) ? depth_image(frame.view) : read(kind.channels), {}});
    layers.back().image.words.emplace(layers.back().image.words.begin(), "Description",
                                      kind.meaning);
  }
  return layers;
}

void Layers::draw(const Pass& pass, Pieces& pieces, const Chips& chips) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, is_depth(pass.name) ? depth_framebuffer_ : framebuffer_);
  gl_.ClearColor(0, 0, 0, 0);
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
}

std::vector<float> Layers::read_metres() const {
  const auto columns = static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_);
  std::vector<float> below(columns * rows), metres;
  gl_.ReadPixels(0, 0, width_, height_, GL_RED, GL_FLOAT, below.data());
  for (std::size_t row = rows; row-- > 0;) {
    for (std::size_t x = 0; x < columns; ++x) {
      const float depth_m = below[row * columns + x];
      metres.push_back(depth_m > 0 ? depth_m : std::numeric_limits<float>::infinity());
    }
  }
  return metres;
}

/// Returns layer "depth". All images have the scale of the first, a power of two, so that parts of
/// a run drawn separately agree unless their camera distances differ by a factor of two.
Image16 Layers::depth_image(const View& view) {
  constexpr double kWhite = 65535;
  if (!far_m_) {
    const double behind_m = 4 * (view.target_W - view.eye_W).norm();
    far_m_ = std::exp2(std::ceil(std::log2(std::max(behind_m, 1e-3))));
  }
  Image16 image{width_, height_, 1, {}, {}};
  for (const float depth_m : read_metres()) {
    const double level = std::min(kWhite, kWhite * double{depth_m} / *far_m_);
    image.values.push_back(static_cast<std::uint16_t>(std::lround(level)));
  }
  std::array<char, 32> far;
  std::snprintf(far.data(), far.size(), "%.9g", *far_m_);
  image.words = {{"near_m", "0"}, {"far_m", far.data()}};
  return image;
}

Image16 Layers::read(int channels) const {
  const auto columns = static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_);
  std::vector<std::uint16_t> pixels(4 * columns * rows);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_SHORT, pixels.data());
  Image16 image{width_, height_, channels, {}, {}};
  for (std::size_t row = rows; row-- > 0;) {
    for (std::size_t x = 0; x < columns; ++x) {
      for (int c = 0; c < channels; ++c)
        image.values.push_back(pixels[4 * (row * columns + x) + static_cast<std::size_t>(c)]);
    }
  }
  return image;
}

}  // namespace sunder::render
