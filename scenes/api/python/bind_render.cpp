// Draws frames as images in memory.
#include <stdexcept>
#include <thread>

#include "engine/base/check.h"
#include "render/renderer.h"
#include "scenes/api/python/bindings.h"

namespace sunder::python {
namespace {

/// A view that replaces parts of a frame's own.
struct Camera {
  std::optional<Vec3> eye, target;
  std::optional<double> fov_rad;
};

/// Returns the frame with another view; the frame itself if the camera changes nothing.
FramePtr seen_by(const FramePtr& frame, const Camera& camera) {
  if (!camera.eye && !camera.target && !camera.fov_rad) return frame;
  const auto changed = std::make_shared<Frame>(*frame);
  if (camera.eye) changed->view.eye_W = *camera.eye;
  if (camera.target) changed->view.target_W = *camera.target;
  if (camera.fov_rad) changed->view.fov_rad = *camera.fov_rad;
  return changed;
}

py::array_t<std::uint8_t> array_of(const render::Image& image) {
  const py::ssize_t channels = image.alpha.empty() ? 3 : 4;
  py::array_t<std::uint8_t> array({py::ssize_t{image.height}, py::ssize_t{image.width}, channels});
  std::uint8_t* to = array.mutable_data();
  const std::size_t pixels = image.rgb.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) *to++ = image.rgb[3 * i + c];
    if (channels == 4) *to++ = image.alpha[i];
  }
  return array;
}

py::array array_of(const render::Layer& layer, int width, int height) {
  if (layer.image.values.empty()) {
    return py::array_t<float>({height, width}, layer.metres.data());
  }
  const render::Image16& image = layer.image;
  if (image.channels == 1) {
    return py::array_t<std::uint16_t>({image.height, image.width}, image.values.data());
  }
  return py::array_t<std::uint16_t>({image.height, image.width, image.channels},
                                    image.values.data());
}

/// A renderer, which only the thread that made it may use.
class ThreadRenderer {
 public:
  explicit ThreadRenderer(const render::RenderOptions& options) {
    const py::gil_scoped_release release;
    renderer_ = std::make_unique<render::Renderer>(options);
  }
  ~ThreadRenderer() {
    // A context can only be destroyed by its own thread.
    if (std::this_thread::get_id() != thread_) static_cast<void>(renderer_.release());
  }
  ThreadRenderer(const ThreadRenderer&) = delete;
  ThreadRenderer& operator=(const ThreadRenderer&) = delete;

  py::array draw(const SharedFrame& frame, const SharedFrame* before, const Camera& camera) {
    if (std::this_thread::get_id() != thread_) {
      throw std::runtime_error("a Renderer draws on the thread that made it");
    }
    render::Image image;
    {
      const FramePtr seen = seen_by(frame.frame, camera);
      const py::gil_scoped_release release;
      image = renderer_->draw(*seen, before ? before->frame.get() : nullptr);
    }
    return array_of(image);
  }
  py::dict layers() const {
    py::dict layers;
    for (const render::Layer& layer : renderer_->layers()) {
      layers[layer.name.c_str()] = array_of(layer, renderer_->width(), renderer_->height());
    }
    return layers;
  }
  std::string description() const { return renderer_->description(); }

 private:
  std::unique_ptr<render::Renderer> renderer_;
  std::thread::id thread_ = std::this_thread::get_id();
};

render::RenderOptions render_options(int width, int height, const std::string& view_mode,
                                     int samples, bool transparent, bool hud,
                                     const std::vector<std::string>& layers,
                                     const std::string& gl) {
  render::RenderOptions options;
  options.width = width;
  options.height = height;
  options.view_mode = view_mode;
  options.samples = samples;
  options.transparent = transparent;
  options.hud = hud;
  options.layers = layers;
  options.gl = gl;
  return options;
}

}  // namespace

void bind_renderer(py::module_& module) {
  py::class_<ThreadRenderer>(module, "Renderer",
                             "Draws frames off screen, on the thread that made it.")
      .def(py::init([](int width, int height, const std::string& view_mode, int samples,
                       bool transparent, bool hud, const std::vector<std::string>& layers,
                       const std::string& gl) {
             return std::make_unique<ThreadRenderer>(
                 render_options(width, height, view_mode, samples, transparent, hud, layers, gl));
           }),
           py::arg("width") = 1280, py::arg("height") = 720, py::arg("view_mode") = "materials",
           py::arg("samples") = 1, py::arg("transparent") = false, py::arg("hud") = false,
           py::arg("layers") = std::vector<std::string>(), py::arg("gl") = "auto",
           "Makes a renderer. view_mode, samples, layers and gl are as in `sunder render`.")
      .def(
          "draw",
          [](ThreadRenderer& self, const SharedFrame& frame, const SharedFrame* before,
             std::optional<Vec3> eye, std::optional<Vec3> target, std::optional<double> fov_rad) {
            return self.draw(frame, before, {eye, target, fov_rad});
          },
          py::arg("frame"), py::arg("before") = py::none(), py::arg("eye") = py::none(),
          py::arg("target") = py::none(), py::arg("fov_rad") = py::none(),
          "Returns the image of a frame (height, width, 3), uint8, sRGB; of 4 channels if "
          "transparent. before: the previous frame, for motion blur. eye, target, fov_rad: a "
          "camera "
          "in place of the scene's.")
      .def_property_readonly("layers", &ThreadRenderer::layers,
                             "Data layers of the image drawn last, as arrays by name.")
      .def_property_readonly("description", &ThreadRenderer::description,
                             "Context, driver and version of OpenGL.");
  module.def(
      "render",
      [](const SharedFrame& frame, int width, int height, const std::string& view_mode, int samples,
         bool transparent, bool hud, std::optional<Vec3> eye, std::optional<Vec3> target,
         std::optional<double> fov_rad, const std::string& gl) {
        ThreadRenderer renderer(
            render_options(width, height, view_mode, samples, transparent, hud, {}, gl));
        return renderer.draw(frame, nullptr, {eye, target, fov_rad});
      },
      py::arg("frame"), py::arg("width") = 1280, py::arg("height") = 720,
      py::arg("view_mode") = "materials", py::arg("samples") = 1, py::arg("transparent") = false,
      py::arg("hud") = false, py::arg("eye") = py::none(), py::arg("target") = py::none(),
      py::arg("fov_rad") = py::none(), py::arg("gl") = "auto",
      "Returns the image of one frame (height, width, 3), uint8, sRGB; of 4 channels if "
      "transparent. "
      "For many frames a Renderer is faster.");
}

}  // namespace sunder::python
