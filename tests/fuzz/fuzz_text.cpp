// Fuzz targets: any bytes as a camera path, points of a study, stored hashes, a picture, or a
// sealed state give valid data or an InputError.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/base/check.h"
#include "engine/io/sealed_bytes.h"
#include "render/image/image.h"
#include "scenes/file/view.h"
#include "scenes/timing/hash_book.h"
#include "scenes/trade/points.h"
#include "tests/fuzz/fuzz_target.h"

namespace sunder {
namespace {

std::string text_of(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

void read_points(std::span<const std::uint8_t> bytes) {
  try {
    SUNDER_CHECK(!scenes::parse_points(text_of(bytes), "fuzz.points").empty());
  } catch (const InputError&) {
  }
}

void read_hash_book(std::span<const std::uint8_t> bytes) {
  try {
    const scenes::StateHashes book = scenes::parse_hashes(text_of(bytes), "hashes.txt");
    SUNDER_CHECK(scenes::parse_hashes(scenes::format_hashes(book), "again.txt") == book);
  } catch (const InputError&) {
  }
}

void read_camera(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > 4096) return;
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("sunder-fuzz-view-" + std::to_string(getpid()));
  std::ofstream(file, std::ios::binary) << text_of(bytes);
  try {
    SUNDER_CHECK(!scenes::load_view_keys(file).empty());
  } catch (const InputError&) {
  }
  std::filesystem::remove(file);
}

void read_picture(std::span<const std::uint8_t> bytes) {
  try {
    const render::Image image = render::decode_picture(std::as_bytes(bytes));
    SUNDER_CHECK(image.rgb.size() == 3 * static_cast<std::size_t>(image.width) *
                                         static_cast<std::size_t>(image.height));
  } catch (const InputError&) {
  }
}

void open_seal(std::span<const std::uint8_t> bytes) {
  try {
    unseal(std::as_bytes(bytes), "fuzz.state");
  } catch (const InputError&) {
  }
}

const fuzz::Registration text_targets[] = {{"points", read_points},
                                           {"hashes", read_hash_book},
                                           {"view", read_camera},
                                           {"picture", read_picture},
                                           {"sealed", open_seal}};

}  // namespace
}  // namespace sunder
