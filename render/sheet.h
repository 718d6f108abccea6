// A contact sheet: images of several frames in one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "render/sinks.h"

namespace sunder::render {

/// The frames of a sheet: `count` evenly spaced ones from `first` to `last`, both included.
struct SheetFrames {
  std::uint64_t first = 0, last = 0;
  int count = 1;
};

/// Makes a sink that draws these frames into one PNG, row by row, with their times if `captions`. A
/// run that ends early gives a smaller sheet. Throws InputError if `path` is no .png, there are too
/// few frames or the sheet is too large; FileError if `path` cannot be written.
std::unique_ptr<FrameSink> make_sheet_sink(const std::filesystem::path& path, Renderer& renderer,
                                           const SheetFrames& frames, bool captions = true);

}  // namespace sunder::render
