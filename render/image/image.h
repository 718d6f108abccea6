// Pixels, and PNG files of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sunder::render {

/// 8-bit sRGB, three bytes a pixel, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> alpha = {};  ///< A byte a pixel, not multiplied in; empty: opaque.

  bool operator==(const Image&) const = default;
};

/// Figures of pixels, 16 bits a channel, of which there are one or three; top row first.
struct DeepImage {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<std::uint16_t> values;
  std::vector<std::pair<std::string, std::string>> words = {};  ///< ASCII: keys and what they say.
};

/// A layer of a picture, by name: depth, depth_m, normals or ids.
struct Layer {
  std::string name;
  DeepImage image;            ///< Empty if the layer is in metres:
  std::vector<float> metres;  ///< Along the view, top row first; infinite where nothing is.
};

/// Of pixels as red, green, blue, and alpha or something else, from the lowest byte up.
Image unpacked(std::span<const std::uint32_t> pixels, int width, int height, bool has_alpha);

/// The bytes of a PNG file.
std::vector<std::uint8_t> encode_png(const Image& image);
/// Writes to a temporary name and renames; throws FileError if the place cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);
/// The same, with the words in chunks of text.
void write_png(const std::filesystem::path& path, const DeepImage& image);
/// Throws InputError if there is no readable PNG at `path`; its alpha is not read.
Image read_png(const std::filesystem::path& path);

/// A PNG or JPEG in memory. Throws InputError if it is neither, or too large.
Image decode_picture(std::span<const std::byte> bytes);

}  // namespace sunder::render
