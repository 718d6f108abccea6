#include "render/image/hud.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <stb/stb_easy_font.h>

namespace sunder::render {
namespace {

constexpr int kScale = 2;
constexpr int kMargin = 9;  // in pixels of the font

/// A corner of a rectangle, in the layout of stb_easy_font.
struct Corner {
  float x, y, z;
  std::uint8_t color[4];
};

void fill(Image& image, int left, int top, int right, int bottom, std::uint8_t level) {
  for (int y = std::max(0, top); y < std::min(image.height, bottom); ++y) {
    for (int x = std::max(0, left); x < std::min(image.width, right); ++x) {
      std::fill_n(image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x), 3,
                  level);
    }
  }
}

}  // namespace

std::string hud_text(const Frame& frame) {
  const auto moves = [](const FrameBody& body) { return !body.is_static && !body.asleep; };
  std::array<char, 200> text;
  std::snprintf(text.data(), text.size(), "frame %05llu   t %.3f s\npieces %zu   moving %td",
                static_cast<unsigned long long>(frame.index), frame.time_s, frame.instances.size(),
                std::ranges::count_if(frame.bodies, moves));
  return text.data();
}

void draw_text(Image& image, const std::string& text) {
  std::string words = text;
  std::vector<Corner> corners(1200 * text.size() / sizeof(Corner) + 4);
  const int quads = stb_easy_font_print(kMargin, kMargin, words.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  for (const int shadow : {1, 0}) {
    for (int q = 0; q < quads; ++q) {
      const Corner& first = corners[4 * static_cast<std::size_t>(q)];
      const Corner& last = corners[4 * static_cast<std::size_t>(q) + 2];
      const auto at = [&](float v) { return kScale * static_cast<int>(v) + shadow; };
      fill(image, at(first.x), at(first.y), at(last.x), at(last.y), shadow != 0 ? 20 : 245);
    }
  }
}

}  // namespace sunder::render
