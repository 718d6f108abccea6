// Counts what parallel loops would take with more threads, on one thread. Begin with LoopCount.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "engine/base/loop_times.h"
#include "engine/base/trace.h"

namespace sunder {

namespace detail {
class LoopTimer;
}  // namespace detail

/// While it exists, loops that its thread starts run on this thread alone and are timed. A thread
/// has one at most.
class LoopCount {
 public:
  LoopCount();
  ~LoopCount();
  LoopCount(const LoopCount&) = delete;
  LoopCount& operator=(const LoopCount&) = delete;
  /// Returns the times of this thread's loops since the construction of its LoopCount; zero if it
  /// has none, or is in a loop.
  static LoopTimes times();

 private:
  friend detail::LoopTimer;
  void add(double ms);
  void end_loop();

  LoopTimes times_;
  double longest_ms_ = 0;  ///< Longest chunk of the loop so far.
  /// Time of the loop so far of each thread, for each number of threads.
  std::array<std::array<double, kLoopThreads.back()>, kLoopThreads.size()> busy_ms_ = {};
};

namespace detail {

/// Times the chunks of one loop if this thread counts loops, and is in none.
class LoopTimer {
 public:
  LoopTimer() : count_(std::exchange(current_, nullptr)) {}
  ~LoopTimer() { current_ = count_; }
  LoopTimer(const LoopTimer&) = delete;
  LoopTimer& operator=(const LoopTimer&) = delete;

  bool counts() const { return count_ != nullptr; }
  template <class Work>
  void run_chunk(const Work& work) {
    if (!count_) return work();
    const Stopwatch watch;
    work();
    count_->add(watch.ms());
  }
  /// Ends the loop, or one of the loops that wait for each other.
  void end_loop() {
    if (count_) count_->end_loop();
  }

 private:
  friend LoopCount;
  static thread_local LoopCount* current_;
  LoopCount* count_;
};

}  // namespace detail

}  // namespace sunder
