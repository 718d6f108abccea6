#include "render/options.h"

#include <string>

#include "engine/base/check.h"
#include "render/passes/layers.h"

namespace sunder::render {
namespace {

constexpr int kMostPixels = 1 << 24;  // a side; devices draw fewer, and say how many
constexpr int kMostSamples = 4096;

void need(int value, int most, const char* name) {
  if (value >= 1 && value <= most) return;
  throw InputError(std::string("options.") + name + " is " + std::to_string(value) +
                   "; expected 1 to " + std::to_string(most));
}

}  // namespace

const RenderOptions& checked(const RenderOptions& options) {
  need(options.width, kMostPixels, "width");
  need(options.height, kMostPixels, "height");
  need(options.samples, kMostSamples, "samples");
  check_layers(options.layers);
  return options;
}

}  // namespace sunder::render
