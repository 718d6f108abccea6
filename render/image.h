// Pixels, and PNG files of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sunder::render {

/// 8-bit sRGB, three bytes a pixel, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes to a temporary name and renames; throws InputError if the place cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);
/// Throws InputError if there is no readable PNG at `path`.
Image read_png(const std::filesystem::path& path);

}  // namespace sunder::render
