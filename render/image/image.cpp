// PNG files, and pictures, by stb; the one place that holds stb's code.
#include "render/image/image.h"

#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include "engine/base/check.h"

namespace sunder::render {
namespace {

constexpr int kChannels = 3;
constexpr int kMostPixels = 16384;  // a side, of a picture

void append(void* bytes, void* data, int size) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  auto& out = *static_cast<std::vector<std::uint8_t>*>(bytes);
  out.insert(out.end(), begin, begin + size);
}

using Pixels = std::unique_ptr<stbi_uc, void (*)(void*)>;

void keep(const Pixels& pixels, Image& image) {
  const std::size_t size =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * kChannels;
  image.rgb.assign(pixels.get(), pixels.get() + size);
}

}  // namespace

Image opaque(std::span<const std::uint32_t> pixels, int width, int height) {
  Image image{width, height, {}};
  image.rgb.reserve(kChannels * pixels.size());
  for (const std::uint32_t pixel : pixels) {
    for (int c = 0; c < kChannels; ++c)
      image.rgb.push_back(static_cast<std::uint8_t>(pixel >> (8 * c)));
  }
  return image;
}

std::vector<std::uint8_t> encode_png(const Image& image) {
  std::vector<std::uint8_t> bytes;
  const int done = stbi_write_png_to_func(append, &bytes, image.width, image.height, kChannels,
                                          image.rgb.data(), image.width * kChannels);
  SUNDER_CHECK(done != 0);
  return bytes;
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
  return path.string() + ".part-" + std::to_string(::getpid());
}

void replace_file(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw FileError(path.string() + ": cannot be written: " + error.message());
}

void write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  const std::filesystem::path temporary = temporary_name(path);
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) {
    throw FileError(path.string() + ": cannot be written; is the folder there and yours?");
  }
  const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (std::fclose(file) != 0 || !whole) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw FileError(path.string() + ": cannot be written; is the disk full?");
  }
  replace_file(temporary, path);
}

void write_png(const std::filesystem::path& path, const Image& image) {
  write_bytes(path, encode_png(image));
}

Image read_png(const std::filesystem::path& path) {
  Image image;
  int channels = 0;
  const Pixels pixels(stbi_load(path.c_str(), &image.width, &image.height, &channels, kChannels),
                      stbi_image_free);
  if (!pixels) throw InputError(path.string() + ": not a readable PNG: " + stbi_failure_reason());
  keep(pixels, image);
  return image;
}

Image decode_picture(std::span<const std::byte> bytes) {
  const auto refuse = [](const std::string& why) {
    throw InputError("a mesh's picture is no PNG or JPEG that can be shown (" + why +
                     "): save it anew, or say look = \"material\"");
  };
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), 1u << 30));
  Image image;
  int channels = 0;
  if (stbi_info_from_memory(data, size, &image.width, &image.height, &channels) == 0)
    refuse(stbi_failure_reason());
  if (std::max(image.width, image.height) > kMostPixels) refuse("it is too large");
  const Pixels pixels(
      stbi_load_from_memory(data, size, &image.width, &image.height, &channels, kChannels),
      stbi_image_free);
  if (!pixels) refuse(stbi_failure_reason());
  keep(pixels, image);
  return image;
}

}  // namespace sunder::render
