// Figures of pixels as OpenEXR files, which other programs read as they are.
#pragma once

#include <filesystem>
#include <vector>

namespace sunder::render {

/// Writes one channel, Y, which every reader knows, of 32-bit floats, not packed; top row first.
/// Writes to a temporary name and renames. Throws FileError if the place cannot be written.
void write_exr(const std::filesystem::path& path, const std::vector<float>& values, int width,
               int height);

}  // namespace sunder::render
