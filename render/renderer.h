// A frame becomes an image, off-screen.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"
#include "render/image/image.h"
#include "render/sinks.h"

namespace sunder::render {

/// What one pass of the last draw took.
struct PassTime {
  const char* name;
  double ms;
  double cpu_ms;  ///< Processor time of all threads, the software driver's included.
};

/// Owns a GL context; used from the thread that made it. The same frame gives the same bytes.
class Renderer {
 public:
  /// Throws InputError if the context asked for cannot be had, saying what was tried.
  explicit Renderer(const RenderOptions& options);
  ~Renderer();

  /// `before`, if there is one: the frame that what moves has come from, while the shutter of the
  /// view was open; else it is taken to have moved evenly.
  Image draw(const Frame& frame, const Frame* before = nullptr);
  /// Those of the options, of the picture drawn last.
  const std::vector<Layer>& layers() const;
  const RenderOptions& options() const;
  /// Context, driver and version, for logs.
  std::string description() const;
  int width() const;
  int height() const;
  /// In order; empty unless asked for in the options.
  const std::vector<PassTime>& pass_times() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder::render
