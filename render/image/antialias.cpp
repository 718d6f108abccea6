#include "render/image/antialias.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/parallel.h"

namespace sunder::render {
namespace {

constexpr std::uint8_t kMinContrast = 12;        // least contrast of an edge, of 255
constexpr std::uint8_t kMinContrastDivisor = 8;  // least contrast: brightest neighbour / this
constexpr int kMaxEdgeSearch = 16;  // greatest distance to the end of an edge, in pixels
constexpr std::size_t kRowsPerChunk = 16;

/// Brightness of every pixel, with a border of one pixel so that all neighbours exist.
class Luma {
 public:
  Luma(std::span<const std::uint32_t> pixels, int width, int height)
      : stride_(width + 2),
        values_(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height + 2)) {
    for (int y = -1; y <= height; ++y) {
      const int from = std::clamp(y, 0, height - 1);
      fill_row(pixels.data() + static_cast<std::ptrdiff_t>(from) * width, at(0, y), width);
    }
  }

  const std::uint8_t* at(int x, int y) const {
    return values_.data() + static_cast<std::ptrdiff_t>(y + 1) * stride_ + x + 1;
  }
  int stride() const { return stride_; }

 private:
  std::uint8_t* at(int x, int y) {
    return values_.data() + static_cast<std::ptrdiff_t>(y + 1) * stride_ + x + 1;
  }
  static void fill_row(const std::uint32_t* in, std::uint8_t* out, int width) {
    for (int x = 0; x < width; ++x) out[x] = static_cast<std::uint8_t>(in[x] >> 24);
    out[-1] = out[0];
    out[width] = out[width - 1];
  }

  int stride_;
  std::vector<std::uint8_t> values_;
};

/// Marks the pixels of a row that may be on an edge; simple enough for the compiler to vectorise.
void mark_edges(const std::uint8_t* luma, int stride, int width, std::uint8_t* marks) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* l = luma + x;
    const std::uint8_t high =
        std::max(std::max(std::max(l[-stride], l[stride]), l[0]), std::max(l[-1], l[1]));
    const std::uint8_t low =
        std::min(std::min(std::min(l[-stride], l[stride]), l[0]), std::min(l[-1], l[1]));
    const auto least = std::max<std::uint8_t>(kMinContrast, high / kMinContrastDivisor);
    marks[x] = static_cast<std::uint8_t>(high - low) >= least;
  }
}

/// The neighbour of a pixel to blend with, as an offset in pixels, and its share, of 256.
struct Blend {
  int dx = 0;
  int dy = 0;
  int share = 0;
};

/// The end of an edge between two rows or columns of pixels, in one direction.
struct EdgeEnd {
  int distance;  ///< Distance to the end, in pixels.
  int change;    ///< Change of twice the mean brightness at the end; 0 if it is out of reach.
};

EdgeEnd find_edge_end(const std::uint8_t* at, int across, int step, int available, int mean2,
                      int least2) {
  const int reach = std::min(kMaxEdgeSearch, available);
  for (int i = 1; i <= reach; ++i) {
    const int change = at[i * step] + at[i * step + across] - mean2;
    if (std::abs(change) >= least2) return {i, change};
  }
  return {reach + 1, 0};
}

Blend blend_at(const Luma& luma, int x, int y, int width, int height) {
  const std::uint8_t* l = luma.at(x, y);
  const int s = luma.stride();
  const int m = l[0], n = l[-s], e = l[1], w = l[-1], d = l[s];
  const int high = std::max({m, n, e, w, d});
  const int low = std::min({m, n, e, w, d});
  const int nw = l[-s - 1], ne = l[-s + 1], sw = l[s - 1], se = l[s + 1];
  const int bend_y =
      std::abs(nw + sw - 2 * w) + 2 * std::abs(n + d - 2 * m) + std::abs(ne + se - 2 * e);
  const int bend_x =
      std::abs(nw + ne - 2 * n) + 2 * std::abs(w + e - 2 * m) + std::abs(sw + se - 2 * d);
  const bool level = bend_y >= bend_x;  // true if the edge is horizontal
  const int before = level ? n : w;
  const int after = level ? d : e;
  const bool backwards = std::abs(before - m) >= std::abs(after - m);
  const int sign = backwards ? -1 : 1;
  const int across = sign * (level ? s : 1);
  const int other = backwards ? before : after;
  const int along = level ? 1 : s;

  // The nearer end of the edge decides on which side of the stair step this pixel is.
  const int mean2 = m + other;
  const int least2 = std::max(1, std::abs(other - m) / 2);
  const EdgeEnd back = find_edge_end(l, across, -along, level ? x : y, mean2, least2);
  const EdgeEnd ahead =
      find_edge_end(l, across, along, level ? width - 1 - x : height - 1 - y, mean2, least2);
  const EdgeEnd& nearer = back.distance < ahead.distance ? back : ahead;
  int share = 0;
  if (nearer.change != 0 && (nearer.change < 0) != (2 * m - mean2 < 0)) {
    share = 128 - 256 * nearer.distance / (back.distance + ahead.distance);
  }

  // An isolated pixel is not part of an edge and is blended with its surroundings.
  const int around = (2 * (n + d + e + w) + nw + ne + sw + se) / 12;
  const int isolation = std::min(256, 256 * std::abs(around - m) / (high - low));
  const int softened = isolation * isolation / 256 * (3 * 256 - 2 * isolation) / 256;
  share = std::max(share, softened * softened / 256 * 150 / 256);
  return {level ? 0 : sign, level ? sign : 0, std::clamp(share, 0, 128)};
}

/// Copies a row without its alpha; the fourth byte of each pixel is overwritten by the next pixel.
void copy_rgb(const std::uint32_t* in, int width, std::uint8_t* out) {
  for (int x = 0; x + 1 < width; ++x) std::memcpy(out + 3 * x, in + x, 4);
  std::memcpy(out + 3 * (width - 1), in + width - 1, 3);
}

}  // namespace

Image apply_fxaa(std::span<const std::uint32_t> pixels, int width, int height) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  SUNDER_CHECK(pixels.size() == columns * rows);
  const Luma luma(pixels, width, height);
  Image image{width, height, std::vector<std::uint8_t>(3 * columns * rows)};
  for_chunks(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::uint8_t> marks(columns);
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      std::uint8_t* out = image.rgb.data() + 3 * columns * row;
      copy_rgb(pixels.data() + columns * row, width, out);
      mark_edges(luma.at(0, y), luma.stride(), width, marks.data());
      for (int x = 0; x < width; ++x) {
        if (marks[static_cast<std::size_t>(x)] == 0) continue;
        const Blend blend = blend_at(luma, x, y, width, height);
        const int from_x = std::clamp(x + blend.dx, 0, width - 1);
        const int from_y = std::clamp(y + blend.dy, 0, height - 1);
        const std::uint32_t there =
            pixels[static_cast<std::size_t>(from_y) * columns + static_cast<std::size_t>(from_x)];
        for (int c = 0; c < 3; ++c) {
          std::uint8_t& value = out[3 * x + c];
          const int other = static_cast<int>((there >> (8 * c)) & 255);
          value = static_cast<std::uint8_t>(value + (other - value) * blend.share / 256);
        }
      }
    }
  });
  return image;
}

}  // namespace sunder::render
