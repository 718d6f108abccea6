// Reads text files.
#pragma once

#include <filesystem>
#include <string>

#include "engine/io/bytes.h"

namespace sunder::scenes {

/// Returns the whole text of a file. Throws InputError if it cannot be read or is too large.
std::string read_text(const std::filesystem::path& file, const FileKind& kind = file_kinds::kAny);

}  // namespace sunder::scenes
