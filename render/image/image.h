// Images in memory, and PNG and JPEG files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sunder::render {

/// An image in 8-bit sRGB, three bytes per pixel, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> alpha = {};  ///< One byte per pixel, not premultiplied; empty: opaque.

  bool operator==(const Image&) const = default;
};

/// An image of one or three channels of 16 bits, top row first.
struct Image16 {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<std::uint16_t> values;
  std::vector<std::pair<std::string, std::string>> words = {};  ///< ASCII metadata: key, value.
};

/// A data layer of an image, by name: depth, depth_m, normals or ids.
struct Layer {
  std::string name;
  Image16 image;              ///< Empty for depth_m.
  std::vector<float> metres;  ///< depth_m: distance along the view, top row first; may be infinite.
};

/// Converts packed pixels: red, green, blue and, if `has_alpha`, alpha, from the lowest byte up.
Image unpacked(std::span<const std::uint32_t> pixels, int width, int height, bool has_alpha);

/// Returns the bytes of a PNG file.
std::vector<std::uint8_t> encode_png(const Image& image);
/// Writes a PNG file under a temporary name and renames it. Throws FileError if that fails.
void write_png(const std::filesystem::path& path, const Image& image);
/// Writes a PNG file of 16 bits per channel with the metadata as tEXt chunks, under a temporary
/// name, and renames it. Throws FileError if that fails.
void write_png(const std::filesystem::path& path, const Image16& image);
/// Reads a PNG file of 8 bits per channel, with its alpha if it has one. Throws InputError if that
/// fails.
Image read_png(const std::filesystem::path& path);

/// Decodes a PNG or JPEG in memory. Throws InputError if it is neither, or over 16384 pixels a
/// side.
Image decode_picture(std::span<const std::byte> bytes);

}  // namespace sunder::render
