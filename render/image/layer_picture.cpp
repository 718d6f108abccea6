#include "render/image/layer_picture.h"

#include <array>
#include <cmath>
#include <limits>

#include "engine/base/check.h"
#include "engine/base/hash.h"

namespace sunder::render {
namespace {

using Pixel = std::array<std::uint8_t, 3>;

constexpr double kWhite16 = 65535;
constexpr double kStepsPerUnit = 1024;  // steps of layer "depth" that are drawn as a metre
constexpr double kGreenBands = 2, kBlueBands = 8;  // bands per doubling of 1 m and the depth
constexpr double kHalfRed_m = 16;

std::uint8_t level(double part) { return static_cast<std::uint8_t>(std::lround(255 * part)); }

/// Returns 0 to 1 and back to 0 as `x` grows by 1.
double wave(double x) { return 1 - std::abs(2 * (x - std::floor(x)) - 1); }

Pixel depth_pixel(double depth_m) {
  if (std::isinf(depth_m)) return {255, 255, 255};
  const double doublings = std::log2(1 + depth_m);
  return {level(depth_m / (depth_m + kHalfRed_m)), level(wave(kGreenBands * doublings)),
          level(wave(kBlueBands * doublings))};
}

Pixel body_pixel(std::uint64_t body) {
  if (body == 0) return {0, 0, 0};
  const std::uint64_t bits = mix(body);
  return {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
          static_cast<std::uint8_t>(bits >> 16)};
}

}  // namespace

Image layer_picture(const Layer& layer, int width, int height) {
  Image image{width, height, {}};
  const auto add = [&](const Pixel& pixel) {
    image.rgb.insert(image.rgb.end(), pixel.begin(), pixel.end());
  };
  for (const float depth_m : layer.metres) add(depth_pixel(double{depth_m}));
  const std::vector<std::uint16_t>& values = layer.image.values;
  if (layer.image.channels == 1) {
    for (const std::uint16_t value : values) {
      const double steps =
          value == kWhite16 ? std::numeric_limits<double>::infinity() : static_cast<double>(value);
      add(depth_pixel(steps / kStepsPerUnit));
    }
  } else {
    SUNDER_CHECK(layer.name == "ids" || layer.name == "normals");
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
      if (layer.name == "ids") {
        add(body_pixel(values[i] + (std::uint64_t{values[i + 1]} << 16)));
      } else {
        add({level(values[i] / kWhite16), level(values[i + 1] / kWhite16),
             level(values[i + 2] / kWhite16)});
      }
    }
  }
  return image;
}

}  // namespace sunder::render
