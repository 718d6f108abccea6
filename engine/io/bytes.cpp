#include "engine/io/bytes.h"

#include <unistd.h>

#include <fstream>
#include <optional>

#include <xxhash.h>

#include "engine/io/unfinished_file.h"

namespace sunder {

void check_file_size(const std::filesystem::path& path, const FileKind& kind) {
  std::error_code error;
  const std::uintmax_t size =
      std::filesystem::is_regular_file(path, error) ? std::filesystem::file_size(path, error) : 0;
  if (error || size <= kind.most_bytes) return;  // reading it reports the error
  throw InputError(path.string() + ": has " + std::to_string(size) + " bytes; " + kind.name +
                   " may have at most " + std::to_string(kind.most_bytes));
}

std::vector<std::byte> read_file(const std::filesystem::path& path, const FileKind& kind) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in || !std::filesystem::is_regular_file(path)) {
    throw InputError(path.string() + ": cannot be read; check the name and permissions");
  }
  check_file_size(path, kind);
  std::vector<std::byte> bytes(static_cast<std::size_t>(in.tellg()));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(path.string() + ": cannot be read completely");
  return bytes;
}

bool begins_with(const std::filesystem::path& path, std::string_view start) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::string first(start.size(), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(first.data(), static_cast<std::streamsize>(first.size()));
  return in && first == start;
}

std::uint64_t hash_bytes(const std::vector<std::byte>& bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::filesystem::path place_of(const std::filesystem::path& path) {
  constexpr int kMaxLinks = 40;
  std::filesystem::path place = path;
  std::error_code error;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(place, error); ++i)
    place = place.parent_path() / std::filesystem::read_symlink(place, error);
  return place;
}

bool is_device(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
  return place_of(path).string() + ".part-" + std::to_string(::getpid());
}

std::ofstream create_file(const std::filesystem::path& path) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  std::ofstream out(path, std::ios::binary);
  if (!out)
    throw FileError(path.string() + ": cannot be written; check the folder and its permissions");
  return out;
}

void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::optional<UnfinishedFile> unfinished;
  if (!is_device(path)) unfinished.emplace(path);
  const std::filesystem::path& file = unfinished ? unfinished->path() : path;
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::binary);
  const bool opened = out.is_open();
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    throw FileError(path.string() + ": cannot be written; " +
                    (opened ? "is the disk full?" : "check the folder and its permissions"));
  }
  if (unfinished) unfinished->publish();
}

}  // namespace sunder
