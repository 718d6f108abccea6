// Frames to files: video through the ffmpeg program, or PNG images.
#pragma once

#include <filesystem>
#include <memory>

#include "render/renderer.h"

namespace sunder::render {

/// `path` ending in .mp4: a video of 60 frames a second; .png: the last frame taken; otherwise a
/// directory of frame_00000.png and so on. Nothing stands at `path` until it is complete.
/// Throws InputError if ffmpeg is missing (naming the package) or the place cannot be written.
std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path, Renderer& renderer);

}  // namespace sunder::render
