// Video encoding by the ffmpeg program, which gets raw images through a socket.
#pragma once

#include <filesystem>

#include "render/image/image.h"

namespace sunder::render {

/// Encodes an MP4 (H.264) or, by the extension of the path, a WebM (VP9), in yuv420p. The file
/// exists at `path` only after finish().
class Encoder {
 public:
  /// Starts ffmpeg. Throws InputError if ffmpeg is missing (naming the package) or the size is odd.
  Encoder(const std::filesystem::path& path, int width, int height, int frames_per_s);
  /// Kills ffmpeg and removes its file if the video is not finished.
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Appends a frame. Throws FileError with ffmpeg's error output, or if ffmpeg stopped.
  void add(const Image& image);
  void finish();

 private:
  /// Closes the input and waits for ffmpeg to end. Returns true if it succeeded.
  bool close_and_wait();
  bool has_error_output() const;
  [[noreturn]] void fail();

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int width_;
  int height_;
  int pid_ = -1;
  int input_ = -1;
  int log_ = -1;  ///< Output of ffmpeg: a file in memory, so that writing to it never blocks.
};

}  // namespace sunder::render
