// Where the time went: a stopwatch for stages, and spans of every thread's time for a trace.
#pragma once

#include <atomic>
#include <chrono>
#include <vector>

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

/// A span of a thread's time, as it was traced.
struct TracedSpan {
  const char* name = "";
  int thread = 0;  ///< In the order in which they were first traced.
  double begin_us = 0, duration_us = 0;
};

/// From now on spans are kept, until what there is is taken. Not while other threads work.
void start_trace();
/// All that were kept, by thread and end, and stops.
std::vector<TracedSpan> take_trace();

namespace detail {
extern std::atomic<bool> tracing;
double trace_begin(const char* name, const char*& outer);
void trace_end(const char* name, const char* outer, double begin_us);
}  // namespace detail

/// This thread's innermost span; null if none, or if nobody traces.
const char* traced_span();

/// From here to the end of the block; costs a look at a flag while nobody traces. The name must
/// live for ever; null: no span.
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
