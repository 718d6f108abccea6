// Selection and description of the OpenGL context.
#include "render/gl/context.h"

#include <charconv>
#include <functional>
#include <vector>

#include "engine/base/check.h"

namespace sunder::render {
namespace {

using Maker = std::function<std::unique_ptr<GlContext>()>;

/// Returns the index N of "egl-device:N", or -1 for any other text.
int device_index(const std::string& wanted) {
  const std::string prefix = "egl-device:";
  if (!wanted.starts_with(prefix)) return -1;
  int index = -1;
  const char* begin = wanted.data() + prefix.size();
  const char* end = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(begin, end, index);
  return error == std::errc() && stop == end && index >= 0 ? index : -1;
}

/// Returns the functions that may make a `wanted` context, best first; empty for an unknown name.
std::vector<Maker> makers(const std::string& wanted) {
  if (wanted == "egl-surfaceless") return {make_egl_surfaceless};
  if (wanted == "osmesa") return {make_osmesa};
  if (const int index = device_index(wanted); index >= 0) {
    return {[index] { return make_egl_device(index); }};
  }
  if (wanted != "auto") return {};

  const std::vector<bool> hardware = egl_devices_hardware();
  std::vector<Maker> list;
  const auto add_devices = [&](bool kind) {
    for (std::size_t i = 0; i < hardware.size(); ++i) {
      if (hardware[i] == kind)
        list.emplace_back([i] { return make_egl_device(static_cast<int>(i)); });
    }
  };
  add_devices(true);
  list.emplace_back(make_egl_surfaceless);
  add_devices(false);
  list.emplace_back(make_osmesa);
  return list;
}

}  // namespace

void GlContext::check_and_describe(const char* missing) {
  if (missing != nullptr) throw InputError(kind_ + ": the driver has no " + missing);
  GLint major = 0;
  GLint minor = 0;
  gl_.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl_.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 33) {
    throw InputError(kind_ + ": OpenGL " + std::to_string(major) + "." + std::to_string(minor) +
                     ", but 3.3 is needed");
  }
  const auto text = [&](GLenum name) {
    return std::string(reinterpret_cast<const char*>(gl_.GetString(name)));
  };
  description_ = kind_ + ": " + text(GL_RENDERER) + ", " + text(GL_VERSION);
}

std::unique_ptr<GlContext> make_context(const std::string& wanted) {
  const std::vector<Maker> list = makers(wanted);
  if (list.empty()) {
    throw InputError("--gl " + wanted +
                     ": unknown; allowed are auto, egl-device:N, egl-surfaceless, osmesa");
  }
  std::string reasons;
  for (const Maker& make : list) {
    try {
      return make();
    } catch (const InputError& error) {
      reasons += "\n  ";
      reasons += error.what();
    }
  }
  throw InputError("--gl " + wanted + ": no OpenGL context to be had; tried:" + reasons +
                   "\nOn Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri");
}

}  // namespace sunder::render
