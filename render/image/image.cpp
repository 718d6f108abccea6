// Images by the stb libraries, whose code is compiled in this file alone.
#include "render/image/image.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include "engine/base/check.h"
#include "engine/io/bytes.h"

namespace sunder::render {
namespace {

constexpr int kChannels = 3;
constexpr int kMaxDecodedSide = 16384;  // greatest width and height of a decoded picture
/// Most pixels that a byte of a PNG or JPEG can hold: deflate packs 1032 bytes of 8 pixels into
/// one.
constexpr std::uint64_t kMaxPixelsPerByte = 8 * 1032;

void append(void* bytes, void* data, int size) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  auto& out = *static_cast<std::vector<std::uint8_t>*>(bytes);
  out.insert(out.end(), begin, begin + size);
}

using Pixels = std::unique_ptr<stbi_uc, void (*)(void*)>;

std::size_t count_pixels(const Image& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// Returns the picture of a PNG or JPEG file, with the alpha that it has if asked; calls refuse()
/// with the reason if it has no picture.
template <class Refuse>
Image decode(std::span<const std::byte> bytes, bool with_alpha, const Refuse& refuse) {
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), 1u << 30));
  Image image;
  int channels = 0;
  if (stbi_info_from_memory(data, size, &image.width, &image.height, &channels) == 0)
    refuse(stbi_failure_reason());
  if (std::max(image.width, image.height) > kMaxDecodedSide) refuse("it is too large");
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  if (pixels / kMaxPixelsPerByte > bytes.size()) refuse("it is truncated");
  const Pixels decoded(
      stbi_load_from_memory(data, size, &image.width, &image.height, &channels, kChannels + 1),
      stbi_image_free);
  if (!decoded) refuse(stbi_failure_reason());
  const bool has_alpha = channels == 2 || channels == 4;
  image.rgb.reserve(kChannels * count_pixels(image));
  for (std::size_t i = 0; i < count_pixels(image); ++i) {
    const stbi_uc* const pixel = decoded.get() + (kChannels + 1) * i;
    image.rgb.insert(image.rgb.end(), pixel, pixel + kChannels);
    if (with_alpha && has_alpha) image.alpha.push_back(pixel[kChannels]);
  }
  return image;
}

/// Appends a number, highest byte first (big-endian, as in PNG).
void put_big_endian(std::vector<std::uint8_t>& out, std::uint64_t number, int bytes) {
  while (bytes-- > 0) out.push_back(static_cast<std::uint8_t>(number >> (8 * bytes)));
}

/// Returns the CRC of a chunk (ISO 15948, annex D).
std::uint32_t crc(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0xffffffff;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1) != 0 ? sum >> 1 ^ 0xedb88320 : sum >> 1;
  }
  return ~sum;
}

void put_chunk(std::vector<std::uint8_t>& out, const std::string& kind,
               std::span<const std::uint8_t> content) {
  put_big_endian(out, content.size(), 4);
  const std::size_t summed = out.size();
  out.insert(out.end(), kind.begin(), kind.end());
  out.insert(out.end(), content.begin(), content.end());
  put_big_endian(out, crc(std::span(out).subspan(summed)), 4);
}

/// Returns the compressed rows, each filtered as the difference from the row above ("Up").
std::vector<std::uint8_t> packed_rows(const Image16& image) {
  constexpr std::uint8_t kUp = 2;
  const auto row = static_cast<std::size_t>(image.width * image.channels);
  std::vector<std::uint8_t> above(2 * row), rows;
  for (std::size_t first = 0; first < image.values.size(); first += row) {
    rows.push_back(kUp);
    for (std::size_t i = 0; i < 2 * row; ++i) {
      const auto byte = static_cast<std::uint8_t>(image.values[first + i / 2] >> (i % 2 ? 0 : 8));
      rows.push_back(static_cast<std::uint8_t>(byte - std::exchange(above[i], byte)));
    }
  }
  int size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> packed(
      stbi_zlib_compress(rows.data(), static_cast<int>(rows.size()), &size, 8), std::free);
  SUNDER_CHECK(packed != nullptr);
  return {packed.get(), packed.get() + size};
}

}  // namespace

Image unpacked(std::span<const std::uint32_t> pixels, int width, int height, bool has_alpha) {
  Image image{width, height, {}};
  image.rgb.reserve(kChannels * pixels.size());
  for (const std::uint32_t pixel : pixels) {
    for (int c = 0; c < kChannels; ++c)
      image.rgb.push_back(static_cast<std::uint8_t>(pixel >> (8 * c)));
    if (has_alpha) image.alpha.push_back(static_cast<std::uint8_t>(pixel >> 24));
  }
  return image;
}

std::vector<std::uint8_t> encode_png(const Image& image) {
  std::vector<std::uint8_t> rgba;
  const bool is_opaque = image.alpha.empty();
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    rgba.insert(rgba.end(), &image.rgb[kChannels * i], &image.rgb[kChannels * i] + kChannels);
    rgba.push_back(image.alpha[i]);
  }
  const int channels = is_opaque ? kChannels : kChannels + 1;
  // Filter "Sub" and a lower compression level: a third less time, and files no larger.
  stbi_write_force_png_filter = 1;
  stbi_write_png_compression_level = 5;
  std::vector<std::uint8_t> bytes;
  const int done =
      stbi_write_png_to_func(append, &bytes, image.width, image.height, channels,
                             is_opaque ? image.rgb.data() : rgba.data(), image.width * channels);
  SUNDER_CHECK(done != 0);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(path, std::as_bytes(std::span(bytes)));
}

void write_png(const std::filesystem::path& path, const Image16& image) {
  SUNDER_CHECK(image.channels == 1 || image.channels == 3);
  std::vector<std::uint8_t> bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  std::vector<std::uint8_t> head;
  put_big_endian(head, static_cast<std::uint64_t>(image.width), 4);
  put_big_endian(head, static_cast<std::uint64_t>(image.height), 4);
  head.insert(head.end(), {16, image.channels == 1 ? std::uint8_t{0} : std::uint8_t{2}, 0, 0, 0});
  put_chunk(bytes, "IHDR", head);
  for (const auto& [key, word] : image.words) {
    std::vector<std::uint8_t> text(key.begin(), key.end());
    text.push_back(0);
    text.insert(text.end(), word.begin(), word.end());
    put_chunk(bytes, "tEXt", text);
  }
  put_chunk(bytes, "IDAT", packed_rows(image));
  put_chunk(bytes, "IEND", {});
  write_file(path, std::as_bytes(std::span(bytes)));
}

Image read_png(const std::filesystem::path& path) {
  const std::vector<std::byte> file = read_file(path, file_kinds::kPicture);
  return decode(file, /*with_alpha=*/true, [&](const std::string& why) {
    throw InputError(path.string() + ": not a readable PNG: " + why);
  });
}

Image decode_picture(std::span<const std::byte> bytes) {
  return decode(bytes, /*with_alpha=*/false, [](const std::string& why) {
    throw InputError("a texture of a mesh cannot be decoded as PNG or JPEG (" + why +
                     "); save it again, or set look = \"material\"");
  });
}

}  // namespace sunder::render
