// Compares bytes first, then the mean FLIP error for overall differences and a count of differing
// pixels in a window for local ones. Neither alone suffices (docs/decisions: golden images): the
// FLIP mean ranks a missing piece below noise, and a count of pixels misses a change in brightness.
#include "render/image/compare.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "render/image/flip.h"

namespace sunder::render {
namespace {

constexpr int kWindow = 32;
constexpr int kLevels = 8;

/// Finds the window of kWindow x kWindow pixels with the most that differ by more than kLevels.
void find_worst_window(const Image& a, const Image& b, Difference& difference) {
  // sum(x, y) is the number of differing pixels left of x and above y.
  const auto stride = static_cast<std::size_t>(a.width) + 1;
  std::vector<int> sums(stride * (static_cast<std::size_t>(a.height) + 1));
  const auto sum = [&](int x, int y) -> int& {
    return sums[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
  };
  std::size_t i = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x, i += 3) {
      const bool differs = std::abs(a.rgb[i] - b.rgb[i]) > kLevels ||
                           std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > kLevels ||
                           std::abs(a.rgb[i + 2] - b.rgb[i + 2]) > kLevels;
      sum(x + 1, y + 1) = sum(x, y + 1) + sum(x + 1, y) - sum(x, y) + (differs ? 1 : 0);
    }
  }
  for (int y = 0; y < std::max(1, a.height - kWindow + 1); ++y) {
    for (int x = 0; x < std::max(1, a.width - kWindow + 1); ++x) {
      const int right = std::min(a.width, x + kWindow);
      const int bottom = std::min(a.height, y + kWindow);
      const int pixels = sum(right, bottom) - sum(x, bottom) - sum(right, y) + sum(x, y);
      if (pixels <= difference.worst_window_pixels) continue;
      difference.worst_window_pixels = pixels;
      difference.worst_window_x = x;
      difference.worst_window_y = y;
    }
  }
}

/// Colours errors from black through red and yellow to white, so that small ones are visible.
Image heat_map(const Image& like, const std::vector<float>& errors) {
  Image heat{like.width, like.height, {}};
  heat.rgb.reserve(3 * errors.size());
  const auto level = [](float v) {
    return static_cast<std::uint8_t>(255 * std::clamp(v, 0.0f, 1.0f) + 0.5f);
  };
  for (const float error : errors) {
    heat.rgb.push_back(level(3 * error));
    heat.rgb.push_back(level(3 * error - 1));
    heat.rgb.push_back(level(3 * error - 2));
  }
  return heat;
}

/// Returns an image as it looks before a background of this level.
Image before_background(const Image& image, int level) {
  Image flat{image.width, image.height, image.rgb};
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    const int alpha = image.alpha[i];
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      flat.rgb[c] =
          static_cast<std::uint8_t>((image.rgb[c] * alpha + level * (255 - alpha) + 127) / 255);
    }
  }
  return flat;
}

/// Compares images of one size without transparent pixels.
Difference compare_opaque(const Image& reference, const Image& actual) {
  Difference difference;
  difference.same_size = true;
  const std::vector<float> errors = flip_errors(reference, actual);
  double sum = 0;
  for (const float error : errors) sum += static_cast<double>(error);
  difference.flip_mean = sum / static_cast<double>(errors.size());
  find_worst_window(reference, actual, difference);
  difference.heat_map = heat_map(reference, errors);
  return difference;
}

/// Returns a value as a fraction of the most that is allowed.
double fraction(double value, double most) {
  if (value <= 0) return 0;
  return most > 0 ? value / most : std::numeric_limits<double>::infinity();
}

}  // namespace

double Difference::share_of(const Thresholds& thresholds) const {
  if (same_bytes) return 0;
  if (!same_size) return std::numeric_limits<double>::infinity();
  return std::max(fraction(flip_mean, thresholds.flip_mean),
                  fraction(worst_window_pixels, thresholds.window_pixels));
}

Difference compare(const Image& reference, const Image& actual) {
  Difference difference;
  difference.same_size = reference.width == actual.width && reference.height == actual.height;
  difference.same_bytes = reference == actual;
  if (difference.same_bytes || !difference.same_size) return difference;
  if (reference.alpha.empty() && actual.alpha.empty()) return compare_opaque(reference, actual);

  Difference black = compare_opaque(before_background(reference, 0), before_background(actual, 0));
  Difference white =
      compare_opaque(before_background(reference, 255), before_background(actual, 255));
  Difference worst = white.worst_window_pixels > black.worst_window_pixels ? white : black;
  if (black.flip_mean > white.flip_mean) std::swap(black, white);
  worst.flip_mean = white.flip_mean;
  worst.heat_map = std::move(white.heat_map);
  return worst;
}

}  // namespace sunder::render
