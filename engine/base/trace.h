// Time measurement: a stopwatch for stages, and a trace of named spans of all threads.
#pragma once

#include <atomic>
#include <chrono>
#include <vector>

namespace sunder {

/// Measures wall time since construction or the last call of lap_ms().
class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  /// Returns the elapsed time in ms and restarts the stopwatch.
  double lap_ms() {
    const double elapsed = ms();
    start_ = Clock::now();
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// A named interval of a thread's time.
struct TracedSpan {
  const char* name = "";
  int thread = 0;  ///< Number of the thread, in order of first use.
  double begin_us = 0, duration_us = 0;
};

/// Starts recording spans until stop_trace(). No other thread may be in a span.
void start_trace();
/// Stops recording and returns all spans, sorted by thread, then by time of their end.
std::vector<TracedSpan> stop_trace();

namespace detail {
extern std::atomic<bool> tracing;
double trace_begin(const char* name, const char*& outer);
void trace_end(const char* name, const char* outer, double begin_us);
}  // namespace detail

/// Returns the name of this thread's innermost span; null if there is none or no recording.
const char* current_span_name();

/// Records a span from its construction to the end of the block. Costs one test of a flag while
/// nothing is recorded. The name must have static lifetime; a null name records nothing.
class TraceSpan {
 public:
  explicit TraceSpan(const char* name) {
    if (!name || !detail::tracing.load(std::memory_order_relaxed)) return;
    name_ = name;
    begin_us_ = detail::trace_begin(name, outer_);
  }
  ~TraceSpan() {
    if (name_) detail::trace_end(name_, outer_, begin_us_);
  }
  TraceSpan(const TraceSpan&) = delete;
  TraceSpan& operator=(const TraceSpan&) = delete;

 private:
  const char *name_ = nullptr, *outer_ = nullptr;
  double begin_us_ = 0;
};

}  // namespace sunder
