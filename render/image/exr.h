// Writing of OpenEXR files.
#pragma once

#include <filesystem>
#include <vector>

namespace sunder::render {

/// Writes one channel "Y" of uncompressed 32-bit floats, top row first, under a temporary name, and
/// renames the file. Throws FileError if that fails.
void write_exr(const std::filesystem::path& path, const std::vector<float>& values, int width,
               int height);

}  // namespace sunder::render
