// Times of parallel loops with any number of threads, derived from a run on one thread: large
// machines can be simulated on small ones. Begin with LoopCount.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "engine/base/trace.h"

namespace sunder {

/// Numbers of threads that loops are timed for.
inline constexpr std::array<int, 4> kLoopThreads = {2, 4, 8, 16};

/// Time spent in parallel loops, in ms. Handing work to threads counts as free.
struct LoopTimes {
  double work_ms = 0;  ///< With one thread.
  double span_ms = 0;  ///< With a thread for each chunk: the longest chunk of each loop.
  /// With kLoopThreads threads: each chunk goes, in order, to the thread that is free first.
  std::array<double, kLoopThreads.size()> threads_ms = {};

  LoopTimes& operator+=(const LoopTimes& other) { return add(other, 1); }
  LoopTimes operator-(const LoopTimes& other) const { return LoopTimes(*this).add(other, -1); }

 private:
  LoopTimes& add(const LoopTimes& other, double sign) {
    work_ms += sign * other.work_ms;
    span_ms += sign * other.span_ms;
    for (std::size_t i = 0; i < threads_ms.size(); ++i) threads_ms[i] += sign * other.threads_ms[i];
    return *this;
  }
};

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
