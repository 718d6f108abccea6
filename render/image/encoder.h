// Video encoding by the ffmpeg program, which gets raw images through a socket.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "engine/io/unfinished_file.h"
#include "render/image/image.h"

namespace sunder::render {

/// Encodes an MP4 (H.264) or, by the extension of the path, a WebM (VP9), in yuv420p. The file
/// exists at `path` only after finish().
class Encoder {
 public:
  /// Starts ffmpeg. Throws InputError if ffmpeg is missing (naming the package) or the size is odd.
  /// As soon as `is_stopped` returns true, if it is given, ffmpeg is killed if it hangs: if it has
  /// taken no input and used no processor time for 0.8 s.
  Encoder(const std::filesystem::path& path, int width, int height, int frames_per_s,
          std::function<bool()> is_stopped = {});
  /// Kills ffmpeg and removes its file if the video is not finished.
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Appends a frame. Throws FileError with ffmpeg's error output, or if ffmpeg stopped or was
  /// killed.
  void add(const Image& image);
  /// Waits for ffmpeg to complete the file. Throws as add() does.
  void finish();

 private:
  void wait_for_room();
  /// Closes the input and waits for ffmpeg to end. Returns true if it succeeded.
  bool close_and_wait();
  void note_work();
  /// Kills ffmpeg if it hangs after a stop.
  void kill_if_hanging();
  bool has_error_output() const;
  [[noreturn]] void fail();

  std::filesystem::path path_;
  UnfinishedFile file_;
  std::function<bool()> is_stopped_;
  int width_;
  int height_;
  int pid_ = -1;
  int input_ = -1;
  int log_ = -1;  ///< Output of ffmpeg: a file in memory, so that writing to it never blocks.
  bool killed_ = false;
  /// When ffmpeg is known to have worked last, and the processor time that it had used by then.
  std::chrono::steady_clock::time_point worked_;
  std::int64_t used_ns_ = 0;
};

}  // namespace sunder::render
