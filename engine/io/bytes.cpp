#include "engine/io/bytes.h"

#include <fstream>

#include <xxhash.h>

namespace sunder {

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in || !std::filesystem::is_regular_file(path)) {
    throw InputError(path.string() + ": cannot be read; check the name and permissions");
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(in.tellg()));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(path.string() + ": cannot be read to its end");
  return bytes;
}

std::uint64_t hash_bytes(const std::vector<std::byte>& bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

void write_file(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  const std::filesystem::path partial = path.string() + ".part";
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  std::ofstream out(partial, std::ios::binary);
  const bool opened = out.is_open();
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) std::filesystem::rename(partial, path, error);
  if (!out || error) {
    std::filesystem::remove(partial, error);
    throw FileError(
        path.string() + ": cannot be written; " +
        (opened && !out ? "is the disk full?" : "check the folder and its permissions"));
  }
}

}  // namespace sunder
