// Video through the ffmpeg program: raw pictures go in by a socket, a file comes out.
#pragma once

#include <filesystem>

#include "render/image/image.h"

namespace sunder::render {

/// An MP4 (H.264) or, by its name, a WebM (VP9) being made, of yuv420p; nothing stands at `path`
/// until finish() returns.
class Encoder {
 public:
  /// Starts ffmpeg. Throws InputError if it is missing (naming the package) or the size is odd.
  Encoder(const std::filesystem::path& path, int width, int height, int frames_per_s);
  /// An unfinished video is given up: ffmpeg is ended and its file removed.
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Throws FileError with ffmpeg's own words if it has any, or stopped.
  void add(const Image& image);
  void finish();

 private:
  /// Ends the input, waits, and tells whether ffmpeg was content.
  bool wait();
  bool has_complained() const;
  [[noreturn]] void fail();

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int width_;
  int height_;
  int pid_ = -1;
  int input_ = -1;
  int log_ = -1;  ///< What ffmpeg said: a file in memory, so that it can never block.
};

}  // namespace sunder::render
