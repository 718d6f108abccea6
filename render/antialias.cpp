#include "render/antialias.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "engine/base/check.h"
#include "engine/base/parallel.h"

namespace sunder::render {
namespace {

constexpr int kFaintest = 12;  // contrast below which nothing is an edge, of 255
constexpr int kRelative = 8;   // and below this part of the brightest neighbour
constexpr int kReach = 16;     // how far an edge is followed, in pixels
constexpr std::size_t kRowsPerChunk = 16;

/// The picture, and its brightness with a border so that neighbours always exist.
class Picture {
 public:
  Picture(std::span<const std::uint8_t> rgba, int width, int height)
      : rgba_(rgba), width_(width), stride_(width + 2), luma_(padded_size(width, height)) {
    for_chunks(static_cast<std::size_t>(height), kRowsPerChunk,
               [&](std::size_t begin, std::size_t end, std::size_t) {
                 for (std::size_t y = begin; y < end; ++y) fill_row(static_cast<int>(y));
               });
    const auto row = static_cast<std::size_t>(stride_);
    std::copy_n(luma_.begin() + stride_, row, luma_.begin());
    std::copy_n(luma_.end() - 2 * stride_, row, luma_.end() - stride_);
  }

  const std::uint8_t* luma(int x, int y) const {
    return luma_.data() + static_cast<std::ptrdiff_t>(y + 1) * stride_ + x + 1;
  }
  const std::uint8_t* rgba(int x, int y) const {
    return rgba_.data() + 4 * (static_cast<std::ptrdiff_t>(y) * width_ + x);
  }
  int stride() const { return stride_; }

 private:
  static std::size_t padded_size(int width, int height) {
    return static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height + 2);
  }
  void fill_row(int y) {
    const std::uint8_t* in = rgba(0, y);
    std::uint8_t* out = luma_.data() + static_cast<std::ptrdiff_t>(y + 1) * stride_;
    for (int x = 0; x < width_; ++x) {
      out[x + 1] = static_cast<std::uint8_t>(
          (77 * in[4 * x] + 150 * in[4 * x + 1] + 29 * in[4 * x + 2]) >> 8);
    }
    out[0] = out[1];
    out[width_ + 1] = out[width_];
  }

  std::span<const std::uint8_t> rgba_;
  int width_;
  int stride_;
  std::vector<std::uint8_t> luma_;
};

/// Which neighbour to blend with, as a step in luma and in pixels, and how much, of 256.
struct Blend {
  int dx = 0;
  int dy = 0;
  int share = 0;
};

/// How far the edge between `at` and `at + across` runs along `step`, and the change of mean
/// brightness where it ends.
struct End {
  int distance;
  int change;
};

End follow(const std::uint8_t* at, int across, int step, int room, int mean2, int least2) {
  const int reach = std::min(kReach, room);
  int change = 0;
  for (int i = 1; i <= reach; ++i) {
    change = at[i * step] + at[i * step + across] - mean2;
    if (std::abs(change) >= least2) return {i, change};
  }
  return {reach + 1, change};
}

Blend blend_at(const Picture& picture, int x, int y, int width, int height) {
  const std::uint8_t* l = picture.luma(x, y);
  const int s = picture.stride();
  const int m = l[0], n = l[-s], e = l[1], w = l[-1], d = l[s];
  const int high = std::max({m, n, e, w, d});
  const int low = std::min({m, n, e, w, d});
  if (high - low < std::max(kFaintest, high / kRelative)) return {};

  const int nw = l[-s - 1], ne = l[-s + 1], sw = l[s - 1], se = l[s + 1];
  const int bend_y =
      std::abs(nw + sw - 2 * w) + 2 * std::abs(n + d - 2 * m) + std::abs(ne + se - 2 * e);
  const int bend_x =
      std::abs(nw + ne - 2 * n) + 2 * std::abs(w + e - 2 * m) + std::abs(sw + se - 2 * d);
  const bool level = bend_y >= bend_x;  // the edge runs left to right
  const int before = level ? n : w;
  const int after = level ? d : e;
  const bool backwards = std::abs(before - m) >= std::abs(after - m);
  const int sign = backwards ? -1 : 1;
  const int across = sign * (level ? s : 1);
  const int other = backwards ? before : after;
  const int along = level ? 1 : s;

  // Follow the edge both ways; the nearer end tells which side of the stair this pixel is on.
  const int mean2 = m + other;
  const int least2 = std::max(1, std::abs(other - m) / 2);
  const End back = follow(l, across, -along, level ? x : y, mean2, least2);
  const End ahead = follow(l, across, along, level ? width - 1 - x : height - 1 - y, mean2, least2);
  const End& nearer = back.distance < ahead.distance ? back : ahead;
  int share = 0;
  if ((nearer.change < 0) != (2 * m - mean2 < 0)) {
    share = 128 - 256 * nearer.distance / (back.distance + ahead.distance);
  }

  // A pixel that stands out alone is no stair: soften it towards its surroundings.
  const int around = (2 * (n + d + e + w) + nw + ne + sw + se) / 12;
  const int alone = std::min(256, 256 * std::abs(around - m) / (high - low));
  const int softened = alone * alone / 256 * (3 * 256 - 2 * alone) / 256;
  share = std::max(share, softened * softened / 256 * 150 / 256);
  return {level ? 0 : sign, level ? sign : 0, std::clamp(share, 0, 128)};
}

}  // namespace

Image antialiased(std::span<const std::uint8_t> rgba, int width, int height) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  SUNDER_CHECK(rgba.size() == 4 * columns * rows);
  const Picture picture(rgba, width, height);
  Image image{width, height, std::vector<std::uint8_t>(3 * columns * rows)};
  for_chunks(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      std::uint8_t* out = image.rgb.data() + 3 * columns * row;
      for (int x = 0; x < width; ++x, out += 3) {
        const Blend blend = blend_at(picture, x, y, width, height);
        const std::uint8_t* here = picture.rgba(x, y);
        const std::uint8_t* there = picture.rgba(std::clamp(x + blend.dx, 0, width - 1),
                                                 std::clamp(y + blend.dy, 0, height - 1));
        for (int c = 0; c < 3; ++c) {
          out[c] = static_cast<std::uint8_t>(here[c] + (there[c] - here[c]) * blend.share / 256);
        }
      }
    }
  });
  return image;
}

}  // namespace sunder::render
