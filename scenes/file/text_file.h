// Text from files.
#pragma once

#include <filesystem>
#include <string>

namespace sunder::scenes {

/// The whole file. Throws InputError if it cannot be read.
std::string read_text(const std::filesystem::path& file);

}  // namespace sunder::scenes
