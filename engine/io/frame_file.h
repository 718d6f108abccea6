// One frame in a file: what golden images are rendered from.
#pragma once

#include <filesystem>

#include "engine/model/frame.h"

namespace sunder {

/// Compressed (zstd) and checksummed; written under a temporary name and renamed.
void write_frame(const std::filesystem::path& path, const Frame& frame);
/// Throws InputError for a file that is missing, truncated, corrupt or of another version.
FramePtr read_frame(const std::filesystem::path& path);

}  // namespace sunder
