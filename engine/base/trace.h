// Where the time went: a stopwatch for stages.
#pragma once

#include <chrono>

namespace sunder {

/// Milliseconds of wall time since it was made or last restarted.
class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  /// The time so far, starting anew.
  double lap_ms() {
    const double elapsed = ms();
    start_ = Clock::now();
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace sunder
