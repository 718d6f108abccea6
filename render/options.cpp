#include "render/options.h"

#include <string>

#include "engine/base/check.h"
#include "render/passes/layers.h"

namespace sunder::render {
namespace {

// Greatest width and height, in pixels; devices have smaller limits, which they report.
constexpr int kMaxImageSide = 1 << 24;
constexpr int kMaxSamples = 4096;

void check_range(int value, int most, const char* name) {
  if (value >= 1 && value <= most) return;
  throw InputError(std::string("options.") + name + " is " + std::to_string(value) +
                   "; expected 1 to " + std::to_string(most));
}

}  // namespace

const RenderOptions& checked_options(const RenderOptions& options) {
  check_range(options.width, kMaxImageSide, "width");
  check_range(options.height, kMaxImageSide, "height");
  check_range(options.samples, kMaxSamples, "samples");
  check_layers(options.layers);
  return options;
}

}  // namespace sunder::render
