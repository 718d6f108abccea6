// Records a run: every frame into a take, while the run goes on.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/io/take/take_blocks.h"
#include "engine/io/take/take_frame.h"
#include "engine/model/frame.h"

namespace sunder {

/// A sink that writes a take on a thread of its own; the same frames give the same bytes. The file
/// can be played up to the last frame that has reached it, however the run ends.
class TakeWriter final : public FrameSink {
 public:
  /// Throws InputError if the file cannot be written.
  explicit TakeWriter(const std::filesystem::path& path);
  ~TakeWriter() override;

  /// Throws InputError if an earlier frame could not be written.
  void take(const FramePtr& frame) override;
  /// Waits until all is written, and adds the index.
  void finish() override;
  /// So far; all of the file after finish().
  std::uint64_t bytes() const { return offset_; }

 private:
  void work();
  void write(const Frame& frame);
  void write_new_meshes(const Frame& frame);
  void append(BlockKind kind, std::uint32_t first, std::uint64_t content_bytes,
              const std::vector<std::byte>& packed);
  void stop();

  std::filesystem::path path_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePtr> queue_;
  bool closed_ = false;
  std::exception_ptr failure_;

  // Of the thread that writes.
  std::ofstream out_;
  std::uint64_t offset_ = 0;
  std::vector<BlockPlace> places_;
  std::shared_ptr<const std::vector<Material>> materials_;
  std::size_t meshes_ = 0;
  std::uint32_t frames_ = 0;
  FrameCoder coder_;
  Packer frame_packer_, other_packer_;
  std::thread thread_;
};

}  // namespace sunder
