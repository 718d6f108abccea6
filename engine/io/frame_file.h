// Files of one frame each, which golden images are rendered from.
#pragma once

#include <filesystem>

#include "engine/model/frame.h"

namespace sunder {

/// Writes a frame, compressed (zstd) and with a checksum, under a temporary name, and renames it.
void write_frame(const std::filesystem::path& path, const Frame& frame);
/// True if a file begins as stored frames of all versions do.
bool is_stored_frame(const std::filesystem::path& path);
/// Returns a frame as it would be read from a file that it was written to.
FramePtr as_stored(const Frame& frame);
/// Reads a frame; throws InputError if it is missing, truncated, corrupt or of another version.
FramePtr read_frame(const std::filesystem::path& path);

}  // namespace sunder
