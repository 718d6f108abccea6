#include "engine/base/trace.h"

#include <memory>
#include <mutex>
#include <utility>

namespace sunder {
namespace {

/// The spans of one thread. Only that thread writes them; the object outlives the thread.
struct ThreadTrace {
  int thread = 0;
  const char* innermost = nullptr;
  std::vector<TracedSpan> spans;
};

std::mutex trace_mutex;  // protects the list, not its elements
std::vector<std::unique_ptr<ThreadTrace>>& traces() {
  static auto* const all =
      new std::vector<std::unique_ptr<ThreadTrace>>;  // never destroyed: threads may outlive main()
  return *all;
}

ThreadTrace& this_thread_trace() {
  thread_local ThreadTrace* mine = nullptr;
  if (!mine) {
    const std::lock_guard lock(trace_mutex);
    traces().push_back(std::make_unique<ThreadTrace>());
    mine = traces().back().get();
    mine->thread = static_cast<int>(traces().size()) - 1;
  }
  return *mine;
}

Stopwatch trace_clock;

}  // namespace

std::atomic<bool> detail::tracing = false;

void start_trace() {
  stop_trace();
  trace_clock = {};
  detail::tracing = true;
}

std::vector<TracedSpan> stop_trace() {
  detail::tracing = false;
  const std::lock_guard lock(trace_mutex);
  std::vector<TracedSpan> all;
  for (const std::unique_ptr<ThreadTrace>& trace : traces()) {
    all.insert(all.end(), trace->spans.begin(), trace->spans.end());
    trace->spans.clear();
  }
  return all;
}

const char* current_span_name() {
  return detail::tracing.load(std::memory_order_relaxed) ? this_thread_trace().innermost : nullptr;
}

double detail::trace_begin(const char* name, const char*& outer) {
  outer = std::exchange(this_thread_trace().innermost, name);
  return 1e3 * trace_clock.ms();
}

void detail::trace_end(const char* name, const char* outer, double begin_us) {
  ThreadTrace& mine = this_thread_trace();
  mine.innermost = outer;
  mine.spans.push_back({name, mine.thread, begin_us, 1e3 * trace_clock.ms() - begin_us});
}

}  // namespace sunder
