// Windowless OpenGL contexts by EGL, on a hardware or software device or Mesa's surfaceless
// platform.
#include <cstring>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "render/gl/context.h"
#include "render/gl/library.h"

namespace sunder::render {
namespace {

struct EglApi {
  Library library{"libEGL.so.1"};
  PFNEGLGETPROCADDRESSPROC procedure = library.find<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress");
  PFNEGLINITIALIZEPROC initialize = library.find<PFNEGLINITIALIZEPROC>("eglInitialize");
  PFNEGLBINDAPIPROC bind_api = library.find<PFNEGLBINDAPIPROC>("eglBindAPI");
  PFNEGLCHOOSECONFIGPROC choose_config = library.find<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig");
  PFNEGLCREATECONTEXTPROC create_context =
      library.find<PFNEGLCREATECONTEXTPROC>("eglCreateContext");
  PFNEGLDESTROYCONTEXTPROC destroy_context =
      library.find<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext");
  PFNEGLMAKECURRENTPROC make_current = library.find<PFNEGLMAKECURRENTPROC>("eglMakeCurrent");
  PFNEGLQUERYSTRINGPROC query_string = library.find<PFNEGLQUERYSTRINGPROC>("eglQueryString");
  // Extension functions; null if the driver is too old.
  PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display =
      extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  PFNEGLQUERYDEVICESEXTPROC query_devices =
      extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  PFNEGLQUERYDEVICESTRINGEXTPROC device_string =
      extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");

  template <class Function>
  Function extension(const char* name) const {
    return reinterpret_cast<Function>(procedure(name));
  }

  std::vector<EGLDeviceEXT> devices() const {
    EGLint count = 0;
    if (query_devices == nullptr || !query_devices(0, nullptr, &count)) return {};
    std::vector<EGLDeviceEXT> list(static_cast<std::size_t>(count));
    if (!query_devices(count, list.data(), &count)) return {};
    list.resize(static_cast<std::size_t>(count));
    return list;
  }
};

class EglContext final : public GlContext {
 public:
  EglContext(EglApi api, std::string kind, EGLenum platform, void* native)
      : api_(api), display_(initialized_display(kind, platform, native)) {
    const EGLint config_wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                    EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (!api_.choose_config(display_, config_wanted, &config, 1, &configs) || configs == 0) {
      throw InputError(kind + ": no configuration for OpenGL");
    }
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             3,
                             EGL_CONTEXT_MINOR_VERSION,
                             3,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_NONE};
    api_.bind_api(EGL_OPENGL_API);
    context_ = api_.create_context(display_, config, EGL_NO_CONTEXT, wanted);
    if (context_ == EGL_NO_CONTEXT) throw InputError(kind + ": no OpenGL 3.3 core context");
    make_current();
    load_functions(std::move(kind), api_.procedure);
  }
  ~EglContext() override {
    // The display is not terminated: it is shared by all contexts of the process.
    api_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    api_.destroy_context(display_, context_);
  }

  void make_current() override {
    api_.bind_api(EGL_OPENGL_API);
    if (!api_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      throw InputError("egl: the context cannot be made current");
    }
  }

 private:
  EGLDisplay initialized_display(const std::string& kind, EGLenum platform, void* native) const {
    if (api_.platform_display == nullptr) throw InputError(kind + ": EGL knows no platforms");
    const EGLDisplay display = api_.platform_display(platform, native, nullptr);
    if (display == EGL_NO_DISPLAY) throw InputError(kind + ": no such display");
    if (!api_.initialize(display, nullptr, nullptr)) {
      throw InputError(kind + ": the display does not initialize");
    }
    const char* extensions = api_.query_string(display, EGL_EXTENSIONS);
    if (extensions == nullptr || !std::strstr(extensions, "EGL_KHR_surfaceless_context")) {
      throw InputError(kind + ": cannot draw without a surface");
    }
    return display;
  }

  EglApi api_;
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::vector<bool> egl_devices_hardware() {
  std::vector<bool> hardware;
  try {
    const EglApi api;
    for (const EGLDeviceEXT device : api.devices()) {
      const char* extensions = api.device_string(device, EGL_EXTENSIONS);
      hardware.push_back(extensions != nullptr &&
                         std::strstr(extensions, "EGL_MESA_device_software") == nullptr);
    }
  } catch (const InputError&) {
    // Without EGL there are no devices; make_context() reports the reason.
  }
  return hardware;
}

std::unique_ptr<GlContext> make_egl_device(int index) {
  const EglApi api;
  const std::string kind = "egl-device:" + std::to_string(index);
  const std::vector<EGLDeviceEXT> devices = api.devices();
  if (static_cast<std::size_t>(index) >= devices.size()) {
    throw InputError(kind + ": there are " + std::to_string(devices.size()) + " devices");
  }
  return std::make_unique<EglContext>(api, kind, EGL_PLATFORM_DEVICE_EXT,
                                      devices[static_cast<std::size_t>(index)]);
}

std::unique_ptr<GlContext> make_egl_surfaceless() {
  return std::make_unique<EglContext>(EglApi(), "egl-surfaceless", EGL_PLATFORM_SURFACELESS_MESA,
                                      EGL_DEFAULT_DISPLAY);
}

}  // namespace sunder::render
