// The two pipelines of FLIP: colour (after spatial filtering by the eye) and features (edges and
// points). Section numbers refer to the paper.
#include "render/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/types.h"

namespace sunder::render {
namespace {

constexpr float kPixelsPerDegree = 67.02f;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::size_t kRowsAChunk = 16;

/// One value per pixel.
struct Plane {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<float> values;

  Plane(std::size_t w, std::size_t h) : width(w), height(h), values(w * h) {}
  float* row(std::size_t y) { return values.data() + y * width; }
  const float* row(std::size_t y) const { return values.data() + y * width; }
};

using Kernel = std::vector<float>;  // odd length, centred

template <class Weight>
Kernel make_kernel(int radius, const Weight& weight) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(weight(static_cast<float>(x)));
  return kernel;
}

/// Scales a kernel so that its positive weights sum to 1 and its negative ones to −1.
Kernel normalized(Kernel kernel) {
  float positive = 0;
  float negative = 0;
  for (const float w : kernel) (w > 0 ? positive : negative) += w;
  for (float& w : kernel) w /= w > 0 ? positive : -negative;
  return kernel;
}

/// Returns `plane` convolved with `along_x`, then `along_y`; border values are repeated outside.
Plane convolved(const Plane& plane, const Kernel& along_x, const Kernel& along_y) {
  const std::size_t w = plane.width;
  const std::size_t h = plane.height;
  const std::size_t radius_x = along_x.size() / 2;
  const std::size_t radius_y = along_y.size() / 2;
  Plane across(w, h);
  for_chunks(h, kRowsAChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<float> padded(w + 2 * radius_x);
    for (std::size_t y = begin; y < end; ++y) {
      const float* row = plane.row(y);
      std::fill_n(padded.begin(), radius_x, row[0]);
      std::copy_n(row, w, padded.begin() + static_cast<std::ptrdiff_t>(radius_x));
      std::fill(padded.end() - static_cast<std::ptrdiff_t>(radius_x), padded.end(), row[w - 1]);
      float* out = across.row(y);
      for (std::size_t k = 0; k < along_x.size(); ++k) {
        for (std::size_t x = 0; x < w; ++x) out[x] += along_x[k] * padded[x + k];
      }
    }
  });
  Plane result(w, h);
  for_chunks(h, kRowsAChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t y = begin; y < end; ++y) {
      float* out = result.row(y);
      for (std::size_t k = 0; k < along_y.size(); ++k) {
        const std::size_t from = std::clamp(y + k, radius_y, radius_y + h - 1) - radius_y;
        const float* in = across.row(from);
        for (std::size_t x = 0; x < w; ++x) out[x] += along_y[k] * in[x];
      }
    }
  });
  return result;
}

// Colour spaces, relative to D65 white, which is linear RGB (1, 1, 1).

float linear_of_srgb(std::uint8_t byte) {
  const float c = static_cast<float>(byte) / 255.0f;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

const Mat3f& xyz_of_rgb() {
  static const Mat3f matrix = [] {
    Mat3f m;
    m << 0.4124564f, 0.3575761f, 0.1804375f,  //
        0.2126729f, 0.7151522f, 0.0721750f,   //
        0.0193339f, 0.1191920f, 0.9503041f;
    const Vec3f white = m * Vec3f::Ones();
    return Mat3f(white.cwiseInverse().asDiagonal() * m);
  }();
  return matrix;
}

/// Converts to the opponent space of the spatial filter (3.2): luma, red-green, blue-yellow.
Vec3f opponent_of_rgb(const Vec3f& rgb) {
  const Vec3f xyz = xyz_of_rgb() * rgb;
  return Vec3f(116 * xyz.y() - 16, 500 * (xyz.x() - xyz.y()), 200 * (xyz.y() - xyz.z()));
}

Vec3f rgb_of_opponent(const Vec3f& opponent) {
  static const Mat3f back = xyz_of_rgb().inverse();
  const float y = (opponent.x() + 16) / 116;
  return back * Vec3f(y + opponent.y() / 500, y, y - opponent.z() / 200);
}

/// Converts to CIELAB with the Hunt effect: dark colours differ less (3.3).
Vec3f hunt_lab_of_rgb(const Vec3f& rgb) {
  constexpr float kDelta = 6.0f / 29;
  const auto curve = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
  };
  const Vec3f xyz = xyz_of_rgb() * rgb;
  const Vec3f f(curve(xyz.x()), curve(xyz.y()), curve(xyz.z()));
  const float lightness = 116 * f.y() - 16;
  const float hunt = 0.01f * lightness;
  return Vec3f(lightness, hunt * 500 * (f.x() - f.y()), hunt * 200 * (f.y() - f.z()));
}

float hyab(const Vec3f& a, const Vec3f& b) {
  const Vec3f d = a - b;
  return std::abs(d.x()) + std::sqrt(d.y() * d.y() + d.z() * d.z());
}

using Planes = std::array<Plane, 3>;

Planes opponent_planes(const Image& image) {
  const auto w = static_cast<std::size_t>(image.width);
  const auto h = static_cast<std::size_t>(image.height);
  std::array<float, 256> linear;
  for (std::size_t i = 0; i < 256; ++i) linear[i] = linear_of_srgb(static_cast<std::uint8_t>(i));
  Planes planes = {Plane(w, h), Plane(w, h), Plane(w, h)};
  for (std::size_t i = 0; i < w * h; ++i) {
    const std::uint8_t* p = &image.rgb[3 * i];
    const Vec3f opponent = opponent_of_rgb(Vec3f(linear[p[0]], linear[p[1]], linear[p[2]]));
    for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].values[i] = opponent[c];
  }
  return planes;
}

/// The eye's spatial filter of a channel (3.2): Gaussians a·√(π/b)·exp(−π²x²/b), x in degrees.
struct Blur {
  struct Term {
    float a;
    float b;
  };
  std::vector<Term> terms;
};

Plane blurred(const Plane& plane, const Blur& blur) {
  constexpr float kWidest = 0.04f;  // the greatest b of all channels, which sets the radius
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * kPixelsPerDegree));
  std::vector<Plane> parts;
  std::vector<float> weights;
  for (const Blur::Term& term : blur.terms) {
    Kernel kernel = make_kernel(radius, [&](float x) {
      const float degrees = x / kPixelsPerDegree;
      return std::exp(-kPi * kPi * degrees * degrees / term.b);
    });
    float sum = 0;
    for (const float w : kernel) sum += w;
    weights.push_back(term.a * std::sqrt(kPi / term.b) * sum * sum);
    kernel = normalized(std::move(kernel));
    parts.push_back(convolved(plane, kernel, kernel));
  }
  float total = 0;
  for (const float w : weights) total += w;
  Plane result(plane.width, plane.height);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t i = 0; i < result.values.size(); ++i) {
      result.values[i] += weights[p] / total * parts[p].values[i];
    }
  }
  return result;
}

/// Returns the spatially filtered colour of every pixel, in Hunt-adjusted CIELAB.
std::vector<Vec3f> perceived_colors(const Planes& opponent) {
  static const Blur kBlurs[3] = {
      {{{1, 0.0047f}}}, {{{1, 0.0053f}}}, {{{34.1f, 0.04f}, {13.5f, 0.025f}}}};
  const Planes b = {blurred(opponent[0], kBlurs[0]), blurred(opponent[1], kBlurs[1]),
                    blurred(opponent[2], kBlurs[2])};
  std::vector<Vec3f> colors(b[0].values.size());
  for_chunks(colors.size(), 8192, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f rgb = rgb_of_opponent(Vec3f(b[0].values[i], b[1].values[i], b[2].values[i]));
      colors[i] = hunt_lab_of_rgb(rgb.cwiseMax(0.0f).cwiseMin(1.0f));
    }
  });
  return colors;
}

/// Maps a colour distance to an error in [0, 1], with small distances spread (3.4).
float color_error(float distance) {
  constexpr float kExponent = 0.7f;
  constexpr float kKnee = 0.4f;
  constexpr float kKneeError = 0.95f;
  static const float largest =
      std::pow(hyab(hunt_lab_of_rgb(Vec3f(0, 1, 0)), hunt_lab_of_rgb(Vec3f(0, 0, 1))), kExponent);
  const float d = std::pow(distance, kExponent);
  if (d < kKnee * largest) return d * kKneeError / (kKnee * largest);
  return kKneeError + (d - kKnee * largest) / (largest - kKnee * largest) * (1 - kKneeError);
}

struct Features {
  std::vector<float> edges;
  std::vector<float> points;
};

/// Returns the strength of edges and points of 0.082 degrees width in the luma (3.5).
Features features(const Plane& luma) {
  const float sigma = 0.5f * 0.082f * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gauss = [&](float x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  const Kernel smooth = normalized(make_kernel(radius, gauss));
  const Kernel slope = normalized(make_kernel(radius, [&](float x) { return -x * gauss(x); }));
  const Kernel bend = normalized(
      make_kernel(radius, [&](float x) { return (x * x / (sigma * sigma) - 1) * gauss(x); }));
  const auto magnitude = [&](const Kernel& kernel) {
    const Plane x = convolved(luma, kernel, smooth);
    const Plane y = convolved(luma, smooth, kernel);
    std::vector<float> result(x.values.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
    }
    return result;
  };
  return {magnitude(slope), magnitude(bend)};
}

Features features_of_opponent(const Planes& opponent) {
  Plane luma = opponent[0];
  for (float& v : luma.values) v = (v + 16) / 116;
  return features(luma);
}

}  // namespace

std::vector<float> flip_errors(const Image& reference, const Image& actual) {
  SUNDER_CHECK(reference.width == actual.width && reference.height == actual.height);
  const Planes opponent_r = opponent_planes(reference);
  const Planes opponent_a = opponent_planes(actual);
  const std::vector<Vec3f> color_r = perceived_colors(opponent_r);
  const std::vector<Vec3f> color_a = perceived_colors(opponent_a);
  const Features feature_r = features_of_opponent(opponent_r);
  const Features feature_a = features_of_opponent(opponent_a);

  std::vector<float> errors(color_r.size());
  for_chunks(errors.size(), 8192, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const float feature = std::max(std::abs(feature_r.edges[i] - feature_a.edges[i]),
                                     std::abs(feature_r.points[i] - feature_a.points[i]));
      const float feature_error = std::sqrt(std::min(1.0f, feature / std::sqrt(2.0f)));
      errors[i] = std::pow(color_error(hyab(color_r[i], color_a[i])), 1 - feature_error);
    }
  });
  return errors;
}

}  // namespace sunder::render
