#include "engine/io/frames_ahead.h"

#include <utility>

namespace sunder {

FramesAhead::FramesAhead(FrameSource& source) : source_(source) {
  thread_ = std::thread([this] { prefetch(); });
}

FramesAhead::~FramesAhead() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

FramePtr FramesAhead::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_ || !ready_.empty(); });
  if (ready_.empty()) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return nullptr;
  }
  FramePtr frame = std::move(ready_.front());
  ready_.pop_front();
  changed_.notify_all();
  return frame;
}

void FramesAhead::prefetch() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stopped_ || ready_.size() < kMaxPrefetched; });
      if (stopped_) return;
    }
    FramePtr frame;
    std::exception_ptr failure;
    try {
      frame = source_.next();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (frame) {
      ready_.push_back(std::move(frame));
    } else {
      failure_ = failure;
      ended_ = true;
    }
    changed_.notify_all();
    if (ended_) return;
  }
}

}  // namespace sunder
