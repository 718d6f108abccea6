// Times of parallel loops with any number of threads.
#pragma once

#include <array>
#include <cstddef>

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

}  // namespace sunder
