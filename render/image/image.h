// Pixels, and PNG files of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace sunder::render {

/// 8-bit sRGB, three bytes a pixel, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  bool operator==(const Image&) const = default;
};

/// Of pixels as red, green, blue and something else, from the lowest byte up.
Image opaque(std::span<const std::uint32_t> pixels, int width, int height);

/// The bytes of a PNG file.
std::vector<std::uint8_t> encode_png(const Image& image);
/// Writes to a temporary name and renames; throws FileError if the place cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);
/// Throws InputError if there is no readable PNG at `path`.
Image read_png(const std::filesystem::path& path);

/// A PNG or JPEG in memory. Throws InputError if it is neither, or too large.
Image decode_picture(std::span<const std::byte> bytes);

/// Where a file is written until it is complete: beside `path`, named after this process.
std::filesystem::path temporary_name(const std::filesystem::path& path);
/// Moves a complete file to its name, or removes it and throws FileError.
void replace_file(const std::filesystem::path& temporary, const std::filesystem::path& path);
/// Writes to a temporary name and renames; throws FileError if the place cannot be written.
void write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace sunder::render
