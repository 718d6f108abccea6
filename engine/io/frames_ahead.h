// The frames of a source, made while those before them are in use.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "engine/model/frame.h"

namespace sunder {

/// A source that asks another, on a thread of its own, for a few frames more than it has been asked
/// for: those are made while the last one is drawn. Frames, their order, and what is thrown where,
/// are the other's.
class FramesAhead final : public FrameSource {
 public:
  /// Nobody else asks `source` from now on, until this is gone.
  explicit FramesAhead(FrameSource& source);
  /// Waits for the frame under way, if there is one.
  ~FramesAhead() override;
  FramePtr next() override;

 private:
  static constexpr std::size_t kMostWaiting = 2;  ///< Frames.

  void work();

  FrameSource& source_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePtr> made_;
  bool stopped_ = false;        ///< Nobody wants more.
  bool ended_ = false;          ///< There are no more,
  std::exception_ptr failure_;  ///< or this came in place of one.
  std::thread thread_;
};

}  // namespace sunder
