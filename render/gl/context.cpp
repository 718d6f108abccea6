// Selection and description of the OpenGL context.
#include "render/gl/context.h"

#include <charconv>
#include <functional>
#include <vector>

#include "engine/base/check.h"
#include "render/gl/tried_contexts.h"

namespace sunder::render {
namespace {

/// A kind of context by its name for --gl, and the function that makes it.
struct Maker {
  std::string kind;
  std::function<std::unique_ptr<GlContext>()> make;
};

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
  const Maker surfaceless{"egl-surfaceless", make_egl_surfaceless};
  const Maker osmesa{"osmesa", make_osmesa};
  const auto device = [](int index) {
    return Maker{"egl-device:" + std::to_string(index), [index] { return make_egl_device(index); }};
  };
  if (wanted == surfaceless.kind) return {surfaceless};
  if (wanted == osmesa.kind) return {osmesa};
  if (const int index = device_index(wanted); index >= 0) return {device(index)};
  if (wanted != "auto") return {};

  const std::vector<bool> hardware = egl_devices_hardware();
  std::vector<Maker> list;
  const auto add_devices = [&](bool kind) {
    for (std::size_t i = 0; i < hardware.size(); ++i) {
      if (hardware[i] == kind) list.push_back(device(static_cast<int>(i)));
    }
  };
  add_devices(true);
  list.push_back(surfaceless);
  add_devices(false);
  list.push_back(osmesa);
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
    throw InputError("--gl " + wanted + ": expected auto, egl-device:N, egl-surfaceless or osmesa");
  }
  std::string reasons;
  for (const Maker& maker : list) {
    try {
      return maker.make();
    } catch (const InputError& error) {
      reasons += "\n  ";
      reasons += error.what();
    }
  }
  throw InputError("--gl " + wanted + ": no OpenGL context could be created; tried:" + reasons +
                   "\nOn Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri");
}

std::vector<TriedContext> try_contexts() {
  std::vector<TriedContext> tried;
  for (const Maker& maker : makers("auto")) {
    TriedContext& result = tried.emplace_back();
    result.kind = maker.kind;
    try {
      result.description = maker.make()->description();
    } catch (const InputError& error) {
      result.reason = error.what();
    }
  }
  return tried;
}

}  // namespace sunder::render
