// OpenGL 3.3 core contexts without a window: EGL on a device or without a surface, or OSMesa. The
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
  /// Makes it the calling thread's context; cheap if it is already.
  virtual void make_current() = 0;

  const GlTable& gl() const { return gl_; }
  /// How it was had, and the driver's own words, e.g. "egl-surfaceless: llvmpipe (...), 4.5 ...".
  const std::string& description() const { return description_; }

 protected:
  /// Fills the function table and checks the version; throws InputError if it will not do.
  template <class Procedure>
  void adopt(std::string kind, const Procedure& procedure) {
    kind_ = std::move(kind);
    adopt_table(fill(gl_, procedure));
  }

 private:
  void adopt_table(const char* missing);

  std::string kind_;
  std::string description_;
  GlTable gl_;
};

/// A current context for `wanted`: auto | egl-device:N | egl-surfaceless | osmesa. Auto tries, in
/// this order, a hardware EGL device, EGL surfaceless, a software EGL device, OSMesa.
/// Throws InputError that says what was tried and why each failed.
std::unique_ptr<GlContext> make_context(const std::string& wanted);

// The makers behind make_context; each throws InputError that says why it cannot.
std::unique_ptr<GlContext> make_egl_device(int index);
std::unique_ptr<GlContext> make_egl_surfaceless();
std::unique_ptr<GlContext> make_osmesa();
/// Whether each EGL device is hardware, in EGL's order; empty if there is no EGL.
std::vector<bool> egl_devices_hardware();

}  // namespace sunder::render
