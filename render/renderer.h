// Off-screen rendering of a frame to an image.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"
#include "render/image/image.h"
#include "render/sinks.h"

namespace sunder::render {

/// Time of one pass of the last draw().
struct PassTime {
  const char* name;
  double ms;
  double cpu_ms;  ///< CPU time of all threads, including those of a software driver.
};

/// Draws frames with OpenGL, on the thread that made it. Equal frames give equal bytes.
class Renderer {
 public:
  /// Makes a GL context. Throws InputError for invalid options or if no kind of context is
  /// available.
  explicit Renderer(const RenderOptions& options);
  ~Renderer();

  /// Draws a frame. For motion blur `before` is the previous frame; if null, bodies are assumed to
  /// have moved with their current velocities.
  Image draw(const Frame& frame, const Frame* before = nullptr);
  /// Returns the layers of the image drawn last, as named in the options.
  const std::vector<Layer>& layers() const;
  /// Returns the options that the renderer was made with.
  const RenderOptions& options() const;
  /// Returns the context, driver and version, for logs.
  std::string description() const;
  /// Returns warnings about the last draw(): textures that are left out or scaled down.
  std::vector<std::string> warnings() const;
  /// Returns the width of the images in pixels.
  int width() const;
  /// Returns the height of the images in pixels.
  int height() const;
  /// Returns the times of the passes in order; empty unless options.time_passes is set.
  const std::vector<PassTime>& pass_times() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder::render
