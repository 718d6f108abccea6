// Binary data of files: sequences of plain values, read with bounds checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/types.h"

namespace sunder {

/// Appends values to a buffer in memory order, little-endian.
class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) {
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    for (const char c : text) put(c);
  }
  template <class Scalar, int size>
  void put(const Eigen::Matrix<Scalar, size, 1>& vector) {
    for (const Scalar number : vector) put(number);
  }
  /// Appends several values in order.
  template <class First, class Second, class... More>
  void put(const First& first, const Second& second, const More&... more) {
    put(first);
    put(second);
    (put(more), ...);
  }
  /// Appends the number of elements, then each element.
  template <class T>
  void put_list(const std::vector<T>& list) {
    put(static_cast<std::uint32_t>(list.size()));
    for (const T& value : list) put(value);
  }
  std::vector<std::byte> bytes;
};

/// Reads values written by ByteWriter; throws InputError naming the file if bytes are missing.
class ByteReader {
 public:
  ByteReader(const std::vector<std::byte>& bytes, std::string file)
      : bytes_(bytes), file_(std::move(file)) {}

  template <class T>
  requires std::is_trivially_copyable_v<T> T take() {
    need(sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  /// Reads the next values into the arguments.
  template <class... T>
  void take_to(T&... values) {
    (take_one(values), ...);
  }
  /// Reads a list written by ByteWriter::put_list().
  template <class T>
  std::vector<T> take_list() {
    std::vector<T> list(take_count(sizeof(T)));
    for (T& value : list) take_one(value);
    return list;
  }
  std::string take_text() {
    const auto size = take_count(1);
    std::string text(size, ' ');
    for (char& c : text) c = take<char>();
    return text;
  }
  /// Reads the number of items of at least `item_bytes` each; throws if the file is too short.
  std::uint32_t take_count(std::size_t item_bytes) {
    const auto count = take<std::uint32_t>();
    need(std::size_t{count} * item_bytes);
    return count;
  }
  /// Returns the next bytes; valid as long as the buffer.
  std::span<const std::byte> take_bytes(std::size_t size) {
    need(size);
    at_ += size;
    return std::span(bytes_).subspan(at_ - size, size);
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  template <class T>
  void take_one(T& value) {
    value = take<T>();
  }
  void take_one(std::string& text) { text = take_text(); }
  template <class Scalar, int size>
  void take_one(Eigen::Matrix<Scalar, size, 1>& vector) {
    for (Scalar& number : vector) number = take<Scalar>();
  }
  void need(std::size_t size) const {
    if (bytes_.size() - at_ < size) throw InputError(file_ + ": the file is truncated or corrupt");
  }
  const std::vector<std::byte>& bytes_;
  std::string file_;
  std::size_t at_ = 0;
};

/// A kind of file, and how large one may be: so that a wrong file name, or a file made to do so,
/// does not take all memory.
struct FileKind {
  const char* name;  ///< With its article, for messages.
  std::uint64_t most_bytes;
};
namespace file_kinds {
inline constexpr std::uint64_t kMebibyte = 1u << 20;
inline constexpr FileKind kAny{"a file that is read whole", 4096 * kMebibyte};
inline constexpr FileKind kScene{"a scene file", 16 * kMebibyte};
inline constexpr FileKind kText{"a text file", 16 * kMebibyte};  ///< Nodes, points, hashes.
inline constexpr FileKind kPattern{"a pattern file", 64 * kMebibyte};
inline constexpr FileKind kCase{"a case file", 256 * kMebibyte};
inline constexpr FileKind kFigures{"a JSON file", 64 * kMebibyte};
inline constexpr FileKind kPicture{"a picture", 256 * kMebibyte};
inline constexpr FileKind kMesh{"a mesh file", 1024 * kMebibyte};
inline constexpr FileKind kFrame{"a stored frame", 1024 * kMebibyte};
inline constexpr FileKind kRun{"a GLB file", 2048 * kMebibyte};
inline constexpr FileKind kState{"a saved state", 4096 * kMebibyte};
}  // namespace file_kinds

/// Throws InputError if the file is larger than its kind may be.
void check_file_size(const std::filesystem::path& path, const FileKind& kind);
/// Returns the content of a file; throws InputError if it cannot be read or is too large.
std::vector<std::byte> read_file(const std::filesystem::path& path,
                                 const FileKind& kind = file_kinds::kAny);
/// True if a regular file begins with `start`; false also if it cannot be read.
bool begins_with(const std::filesystem::path& path, std::string_view start);
/// Returns the XXH3 hash of bytes; equal on every machine.
std::uint64_t hash_bytes(const std::vector<std::byte>& bytes);
/// Returns the path of a file after following symbolic links, dangling ones included.
std::filesystem::path place_of(const std::filesystem::path& path);
/// True if the path exists and is neither a regular file nor a folder: a device or a pipe, which is
/// written to directly and not replaced.
bool is_device(const std::filesystem::path& path);
/// Returns the path of an incomplete file: in the same folder, with the process id in its name.
std::filesystem::path temporary_name(const std::filesystem::path& path);
/// Creates a file to be written in parts, and its folder; throws FileError on failure.
std::ofstream create_file(const std::filesystem::path& path);
/// Writes a file under a temporary name and renames it; writes to a device or pipe directly.
/// Creates the folder. Throws FileError on failure.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
inline void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace sunder
