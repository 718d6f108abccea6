// Begin with remove_unfinished_files(), which may only call what a signal handler may.
#include "engine/io/unfinished_file.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/base/check.h"
#include "engine/io/bytes.h"

namespace sunder {

namespace {

/// An element of the list of unfinished files.
struct Entry {
  std::string path;
  int process = 0;  ///< Process that has the file; a fork of it has not.
  std::atomic<int> writer = 0;
};

/// Length of the list. Further files are removed only with their objects.
constexpr std::size_t kSlots = 64;

/// The list. An element belongs to whoever takes its pointer out.
std::array<std::atomic<Entry*>, kSlots> slots = {};

/// Removes the files of a folder, and the folder.
void remove_folder(const char* path) {
  struct Listed {  // struct linux_dirent64
    std::uint64_t number;
    std::int64_t offset;
    std::uint16_t length;
    std::uint8_t type;
    char name[1];
  };
  const int folder = ::open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  alignas(Listed) char list[4096];
  bool removed = true;
  while (removed) {
    removed = false;
    ::lseek(folder, 0, SEEK_SET);
    for (long size = 0; (size = ::syscall(SYS_getdents64, folder, list, sizeof list)) > 0;) {
      for (long at = 0; at < size;) {
        const auto* const listed = reinterpret_cast<const Listed*>(list + at);
        removed = ::unlinkat(folder, listed->name, 0) == 0 || removed;
        at += listed->length;
      }
    }
  }
  ::close(folder);
  ::rmdir(path);
}

}  // namespace

UnfinishedFile::UnfinishedFile(const std::filesystem::path& place, std::string_view ending)
    : place_(place), path_(temporary_name(place) += ending) {
  auto* const entry = new Entry{path_.string(), ::getpid()};
  for (Entry* none = nullptr; slot_ < kSlots; ++slot_, none = nullptr)
    if (slots[slot_].compare_exchange_strong(none, entry)) return;
  delete entry;
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  take_off();
}

void UnfinishedFile::take_off() {
  if (slot_ == kSlots) return;
  delete slots[slot_].exchange(nullptr);
  slot_ = kSlots;
}

void UnfinishedFile::set_writer(int group) {
  if (slot_ == kSlots) return;
  if (Entry* const entry = slots[slot_]) entry->writer = group;
}

void UnfinishedFile::publish() {
  std::error_code error;
  std::filesystem::rename(path_, place_of(place_), error);
  if (error) throw FileError(place_.string() + ": cannot be written: " + error.message());
  take_off();
}

void remove_unfinished_files() {
  const int process = ::getpid();
  for (auto& slot : slots) {
    auto* const entry = slot.exchange(nullptr);
    if (!entry || entry->process != process) continue;
    if (const int writer = entry->writer; writer > 0) {
      ::kill(-writer, SIGKILL);
      while (::waitpid(writer, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
    const char* const path = entry->path.c_str();
    if (::unlink(path) != 0 && errno == EISDIR) remove_folder(path);
  }
}

}  // namespace sunder
