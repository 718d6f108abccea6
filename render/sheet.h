// A contact sheet: a run at a glance.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "render/sinks.h"

namespace sunder::render {

/// Which frames a sheet shows: `count` of them, the first and the last included, evenly between.
struct SheetFrames {
  std::uint64_t first = 0, last = 0;
  int count = 1;
};

/// Draws those frames side by side into one PNG, row by row, each with its time unless the renderer
/// writes that (`captions`). A run that ends sooner has what it came to. Throws InputError for what
/// is no .png, more pictures than frames, or a sheet too large; FileError if it cannot be written.
std::unique_ptr<FrameSink> make_sheet_sink(const std::filesystem::path& path, Renderer& renderer,
                                           const SheetFrames& frames, bool captions = true);

}  // namespace sunder::render
