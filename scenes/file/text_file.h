// Reads text files.
#pragma once

#include <filesystem>
#include <string>

namespace sunder::scenes {

/// Returns the whole text of a file. Throws InputError if it cannot be read.
std::string read_text(const std::filesystem::path& file);

}  // namespace sunder::scenes
