// OpenGL contexts by OSMesa, Mesa's software renderer to memory, for machines without EGL.
// Mesa 25.1 removed it, so it is a fallback.
#include <cstdint>

#include "render/gl/context.h"
#include "render/gl/library.h"

// Declared here because osmesa.h includes gl.h of the compatibility profile.
extern "C" {
using OSMesaContext = struct osmesa_context*;
}

namespace sunder::render {
namespace {

constexpr int kFormat = 0x22;
constexpr int kDepthBits = 0x30;
constexpr int kProfile = 0x33;
constexpr int kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36;
constexpr int kMinorVersion = 0x37;

struct OsmesaApi {
  Library library{"libOSMesa.so.8"};
  OSMesaContext (*create)(const int*, OSMesaContext) =
      library.find<OSMesaContext (*)(const int*, OSMesaContext)>("OSMesaCreateContextAttribs");
  void (*destroy)(OSMesaContext) = library.find<void (*)(OSMesaContext)>("OSMesaDestroyContext");
  GLboolean (*make_current)(OSMesaContext, void*, GLenum, GLsizei, GLsizei) =
      library.find<GLboolean (*)(OSMesaContext, void*, GLenum, GLsizei, GLsizei)>(
          "OSMesaMakeCurrent");
  GlProcedure (*procedure)(const char*) =
      library.find<GlProcedure (*)(const char*)>("OSMesaGetProcAddress");
};

class OsmesaGlContext final : public GlContext {
 public:
  OsmesaGlContext() {
    if (api_.create == nullptr)
      throw InputError("osmesa: too old, OSMesaCreateContextAttribs is missing");
    const int wanted[] = {kFormat,       GL_RGBA, kDepthBits,    0, kProfile, kCoreProfile,
                          kMajorVersion, 3,       kMinorVersion, 3, 0};
    context_ = api_.create(wanted, nullptr);
    if (context_ == nullptr) throw InputError("osmesa: no OpenGL 3.3 core context");
    make_current();
    load_functions("osmesa", api_.procedure);
  }
  ~OsmesaGlContext() override {
    api_.make_current(nullptr, nullptr, 0, 0, 0);
    api_.destroy(context_);
  }

  void make_current() override {
    // All drawing is to framebuffer objects; this pixel is required but not used.
    if (api_.make_current(context_, pixel_, GL_UNSIGNED_BYTE, 1, 1) == 0) {
      throw InputError("osmesa: the context cannot be made current");
    }
  }

 private:
  OsmesaApi api_;
  OSMesaContext context_ = nullptr;
  std::uint8_t pixel_[4] = {};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa() { return std::make_unique<OsmesaGlContext>(); }

}  // namespace sunder::render
