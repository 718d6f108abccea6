#include "engine/base/build_id.h"

#include <link.h>

#include <cstdint>
#include <cstring>

namespace sunder {
namespace {

struct Search {
  std::uintptr_t code = 0;  ///< Address of code in the object that is searched for.
  std::string id;
};

bool contains(const dl_phdr_info& object, std::uintptr_t address) {
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    if (segment.p_type == PT_LOAD &&
        address - (object.dlpi_addr + segment.p_vaddr) < segment.p_memsz) {
      return true;
    }
  }
  return false;
}

/// Returns the build id among the notes of a segment; empty if there is none.
std::string find_id(const unsigned char* notes, std::size_t size, std::size_t alignment) {
  constexpr char kDigits[] = "0123456789abcdef";
  const auto aligned = [&](std::size_t length) {
    return (length + alignment - 1) / alignment * alignment;
  };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes + at, sizeof note);
    const std::size_t name = at + sizeof note;
    const std::size_t content = name + aligned(note.n_namesz);
    if (content + note.n_descsz > size) break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof "GNU" &&
        std::memcmp(notes + name, "GNU", sizeof "GNU") == 0) {
      std::string id;
      for (std::size_t i = content; i < content + note.n_descsz; ++i) {
        id += kDigits[notes[i] >> 4];
        id += kDigits[notes[i] & 15];
      }
      return id;
    }
    at = content + aligned(note.n_descsz);
  }
  return {};
}

int visit(dl_phdr_info* object, std::size_t, void* data) {
  Search& search = *static_cast<Search*>(data);
  if (!contains(*object, search.code)) return 0;
  for (int i = 0; i < object->dlpi_phnum && search.id.empty(); ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers
    const auto* notes = reinterpret_cast<const unsigned char*>(object->dlpi_addr + segment.p_vaddr);
    search.id = find_id(notes, segment.p_memsz, segment.p_align == 8 ? 8 : 4);
  }
  return 1;
}

}  // namespace

std::string build_id() {
  Search search;
  search.code = reinterpret_cast<std::uintptr_t>(&contains);
  dl_iterate_phdr(&visit, &search);
  return search.id;
}

}  // namespace sunder
