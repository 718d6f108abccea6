// Layout by "OpenEXR File Layout" (openexr.com): attributes, table of row offsets, rows.
#include "render/image/exr.h"

#include <cstdint>
#include <string_view>

#include "engine/base/check.h"
#include "engine/io/bytes.h"

namespace sunder::render {
namespace {

constexpr std::int32_t kMagic = 20000630, kVersion = 2, kFloat = 2;

/// Writes a zero-terminated text.
void put_name(ByteWriter& out, std::string_view name) {
  for (const char c : name) out.put(c);
  out.put('\0');
}

/// Writes an attribute of the header with these values in order.
template <class... Values>
void put_attribute(ByteWriter& out, std::string_view name, std::string_view type,
                   const Values&... values) {
  put_name(out, name);
  put_name(out, type);
  out.put(static_cast<std::int32_t>((sizeof values + ...)));
  (out.put(values), ...);
}

}  // namespace

void write_exr(const std::filesystem::path& path, const std::vector<float>& values, int width,
               int height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  SUNDER_CHECK(values.size() == columns * rows);
  constexpr std::int32_t kZero = 0, kOne = 1;
  const std::int32_t right = width - 1, bottom = height - 1;
  ByteWriter out;
  out.put(kMagic, kVersion);
  put_attribute(out, "channels", "chlist", 'Y', '\0', kFloat, kZero, kOne, kOne, '\0');
  put_attribute(out, "compression", "compression", std::uint8_t{0});
  put_attribute(out, "dataWindow", "box2i", kZero, kZero, right, bottom);
  put_attribute(out, "displayWindow", "box2i", kZero, kZero, right, bottom);
  put_attribute(out, "lineOrder", "lineOrder", std::uint8_t{0});
  put_attribute(out, "pixelAspectRatio", "float", 1.0f);
  put_attribute(out, "screenWindowCenter", "v2f", 0.0f, 0.0f);
  put_attribute(out, "screenWindowWidth", "float", 1.0f);
  out.put('\0');
  const std::size_t row_bytes = columns * sizeof(float), chunk = 8 + row_bytes;
  const std::size_t first = out.bytes.size() + rows * sizeof(std::uint64_t);
  for (std::size_t row = 0; row < rows; ++row) out.put(std::uint64_t{first + row * chunk});
  for (std::size_t row = 0; row < rows; ++row) {
    out.put(static_cast<std::int32_t>(row), static_cast<std::int32_t>(row_bytes));
    for (std::size_t x = 0; x < columns; ++x) out.put(values[row * columns + x]);
  }
  write_file(path, out.bytes);
}

}  // namespace sunder::render
