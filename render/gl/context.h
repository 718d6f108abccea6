// OpenGL 3.3 core contexts without a window: EGL on a device or surfaceless, or OSMesa. The
// libraries are opened at run time; none is linked.
//
// Read first: make_context().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/gl/table.h"

namespace sunder::render {

class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes this the current context of the calling thread; cheap if it is already.
  virtual void make_current() = 0;

  const GlTable& gl() const { return gl_; }
  /// Returns the kind of context, the renderer and the version, for example
  /// "egl-surfaceless: llvmpipe (...), 4.5 ...".
  const std::string& description() const { return description_; }

 protected:
  /// Fills the function table. Throws InputError if a function is missing or the version below 3.3.
  template <class Procedure>
  void load_functions(std::string kind, const Procedure& procedure) {
    kind_ = std::move(kind);
    check_and_describe(fill(gl_, procedure));
  }

 private:
  void check_and_describe(const char* missing);

  std::string kind_;
  std::string description_;
  GlTable gl_;
};

/// Returns a current context of the kind `wanted`: auto | egl-device:N | egl-surfaceless | osmesa.
/// "auto" tries, in this order, hardware EGL devices, EGL surfaceless, software EGL devices,
/// OSMesa. Throws InputError that lists the attempts and the reason of each failure.
std::unique_ptr<GlContext> make_context(const std::string& wanted);

// Functions used by make_context(); each throws InputError with the reason on failure.
std::unique_ptr<GlContext> make_egl_device(int index);
std::unique_ptr<GlContext> make_egl_surfaceless();
std::unique_ptr<GlContext> make_osmesa();
/// Returns for each EGL device, in EGL's order, true if it is hardware; empty without EGL.
std::vector<bool> egl_devices_hardware();

}  // namespace sunder::render
