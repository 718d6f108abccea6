#include "engine/io/scene_export/spool.h"

#include <unistd.h>

#include <string>
#include <vector>

#include "engine/io/bytes.h"

namespace sunder {
namespace {

/// Returns the name of a new file for the parts of a file.
std::string spool_name(const std::filesystem::path& path) {
  const std::string name = "XXXXXX";
  if (is_device(path)) return (std::filesystem::temp_directory_path() / "sunder-").string() + name;
  return temporary_name(path).string() + "-" + name;
}

}  // namespace

Spool::Spool(const std::filesystem::path& path) : path_(path) {
  std::error_code ignored;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  std::string name = spool_name(path);
  const int descriptor = ::mkstemp(name.data());
  if (descriptor >= 0) {
    ::unlink(name.c_str());
    file_.reset(::fdopen(descriptor, "w+b"));
  }
  if (!file_) {
    throw FileError(path_.string() + ": cannot be written; check the folder and its permissions");
  }
}

void Spool::write(std::span<const std::byte> bytes) {
  size_ += bytes.size();
  end_.insert(end_.end(), bytes.begin(), bytes.end());
  if (end_.size() >= kMaxInMemory) flush();
}

void Spool::flush() {
  const bool is_written = std::fwrite(end_.data(), 1, end_.size(), file_.get()) == end_.size() &&
                          std::fflush(file_.get()) == 0;
  if (!is_written) throw FileError(path_.string() + ": cannot be written; is the disk full?");
  end_.clear();
}

void Spool::align() {
  constexpr std::byte kZeros[4] = {};
  write(std::span(kZeros, (4 - size_ % 4) % 4));
}

void Spool::read(const std::function<void(std::span<const std::byte>)>& take) {
  std::rewind(file_.get());
  std::vector<std::byte> block(1 << 16);
  std::uint64_t passed = 0;
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file_.get())) {
    take(std::span(block).first(count));
    passed += count;
  }
  take(end_);
  passed += end_.size();
  if (passed != size_) throw FileError(path_.string() + ": a temporary file cannot be read back");
}

}  // namespace sunder
