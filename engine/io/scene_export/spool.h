// Parts of a file that are written side by side and joined at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace sunder {

/// Bytes in memory, and from kMaxInMemory on in a temporary file without a name, so that nothing is
/// left of it however the program ends.
class Spool {
 public:
  /// Creates the file in the folder of `path`, or in the folder for temporary files if `path` is a
  /// device. Throws FileError that names `path`.
  explicit Spool(const std::filesystem::path& path);
  /// Appends bytes; throws FileError if the disk is full.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  /// Appends zeros until the size is a multiple of 4.
  void align();
  /// Returns the number of bytes.
  std::uint64_t size() const { return size_; }
  /// Passes all bytes on, in order; throws FileError if they cannot be read.
  void read(const std::function<void(std::span<const std::byte>)>& take);

 private:
  static constexpr std::size_t kMaxInMemory = 32 << 20;

  void flush();

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::vector<std::byte> end_;  ///< Bytes that are not in the file.
  std::uint64_t size_ = 0;
};

}  // namespace sunder
