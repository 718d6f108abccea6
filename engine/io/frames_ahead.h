// Prefetching of frames on another thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "engine/model/frame.h"

namespace sunder {

/// A source that prefetches frames of another source on a thread of its own, while the caller draws
/// the last one. Frames, their order and exceptions are those of the other source.
class FramesAhead final : public FrameSource {
 public:
  /// Starts the thread. Nothing else may use `source` until this object is destroyed.
  explicit FramesAhead(FrameSource& source);
  /// Waits until the frame in progress is complete.
  ~FramesAhead() override;
  FramePtr next() override;

 private:
  static constexpr std::size_t kMaxPrefetched = 2;  ///< Largest number of prefetched frames.

  void prefetch();

  FrameSource& source_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePtr> ready_;
  bool stopped_ = false;        ///< True: the thread must end.
  bool ended_ = false;          ///< True: the source has no more frames, or has thrown.
  std::exception_ptr failure_;  ///< Exception that ended the source, if any.
  std::thread thread_;
};

}  // namespace sunder
