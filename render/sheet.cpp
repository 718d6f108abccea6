#include "render/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/check.h"
#include "engine/io/file_ending.h"
#include "render/image/hud.h"
#include "render/renderer.h"

namespace sunder::render {
namespace {

constexpr int kGap = 4;  // pixels
constexpr std::uint8_t kBackgroundLevel = 24;
constexpr int kMaxSheetSide = 32768;

int columns_of(int count) { return static_cast<int>(std::ceil(std::sqrt(count))); }
int side_of(int cells, int pixels) { return cells * (pixels + kGap) - kGap; }

/// Returns the index of the frame that picture number `picture` shows, counted from 0.
std::uint64_t frame_of(const SheetFrames& frames, std::uint64_t picture) {
  const auto gaps = static_cast<std::uint64_t>(std::max(1, frames.count - 1));
  return frames.first + (picture * (frames.last - frames.first) + gaps / 2) / gaps;
}

class SheetSink final : public FrameSink {
 public:
  SheetSink(std::filesystem::path path, Renderer& renderer, const SheetFrames& frames,
            bool captions)
      : path_(std::move(path)), renderer_(renderer), frames_(frames), captions_(captions) {}

  void take(const FramePtr& frame) override {
    const auto done = pictures_.size();
    if (done == static_cast<std::size_t>(frames_.count) || frame->index < frame_of(frames_, done))
      return;
    pictures_.push_back(renderer_.draw(*frame));
    if (!captions_) return;
    std::array<char, 40> text;
    std::snprintf(text.data(), text.size(), "%.3f s", frame->time_s);
    draw_text(pictures_.back(), text.data());
  }

  void finish() override {
    if (!pictures_.empty()) write_png(path_, sheet());
  }

 private:
  Image sheet() const {
    const int columns = columns_of(static_cast<int>(pictures_.size()));
    const int rows = (static_cast<int>(pictures_.size()) + columns - 1) / columns;
    Image all;
    all.width = side_of(columns, renderer_.width());
    all.height = side_of(rows, renderer_.height());
    const auto row_bytes = 3 * static_cast<std::size_t>(all.width);
    all.rgb.assign(row_bytes * static_cast<std::size_t>(all.height), kBackgroundLevel);
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      const Image& picture = pictures_[i];
      const auto wide = static_cast<std::size_t>(picture.width);
      const std::size_t left = i % static_cast<std::size_t>(columns) * (wide + kGap);
      const std::size_t top =
          i / static_cast<std::size_t>(columns) * (static_cast<std::size_t>(picture.height) + kGap);
      for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
        std::copy_n(picture.rgb.data() + 3 * wide * y, 3 * wide,
                    all.rgb.data() + row_bytes * (top + y) + 3 * left);
      }
    }
    return all;
  }

  std::filesystem::path path_;
  Renderer& renderer_;
  SheetFrames frames_;
  bool captions_;
  std::vector<Image> pictures_;
};

}  // namespace

std::unique_ptr<FrameSink> make_sheet_sink(const std::filesystem::path& path, Renderer& renderer,
                                           const SheetFrames& frames, bool captions) {
  const std::string asked = "--sheet " + std::to_string(frames.count) + ": ";
  if (!has_ending(path.string(), ".png")) {
    throw InputError(asked + path.string() + " does not end in .png; a sheet is one PNG image");
  }
  const std::uint64_t available = frames.last - frames.first + 1;
  if (static_cast<std::uint64_t>(frames.count) > available) {
    throw InputError(
        asked + "there are only " + std::to_string(available) +
        " frames to draw; use a smaller number, or draw more frames by --frames or --fps");
  }
  const int columns = columns_of(frames.count);
  const int rows = (frames.count + columns - 1) / columns;
  const int wide = side_of(columns, renderer.width()), tall = side_of(rows, renderer.height());
  if (wide > kMaxSheetSide || tall > kMaxSheetSide) {
    throw InputError(
        asked + "the sheet would have " + std::to_string(wide) + "x" + std::to_string(tall) +
        " pixels, more than 32768 along a side; use a smaller --size, which is that of each image");
  }
  check_output_path(path);
  return std::make_unique<SheetSink>(path, renderer, frames, captions);
}

}  // namespace sunder::render
