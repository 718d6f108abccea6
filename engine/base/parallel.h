// Parallel loops over chunks of fixed size. Chunks do not depend on the number of threads, so
// results do not either. Begin with for_chunks().
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <vector>

#include "engine/base/loop_count.h"
#include "engine/base/trace.h"

namespace sunder {

/// Sets the number of threads of all later parallel loops of the process; 0 means one per
/// processor.
void set_threads(int count);
/// Returns the number of threads of parallel loops that this thread starts.
int threads();

/// While it exists, loops that its thread starts have this number of threads; 0 changes nothing.
class ThreadScope {
 public:
  explicit ThreadScope(int count);
  ~ThreadScope();
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

 private:
  int before_;
};

/// Returns true if other threads could take part in a loop that this thread starts now.
bool can_run_parallel();

/// Number of spin_pause() after which a waiting thread should sleep: they take about as long as
/// waking it.
inline constexpr int kMaxSpins = 1000;

/// Yields the core to its other hardware thread in a spin loop.
inline void spin_pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

namespace detail {
void run_on_free_threads(void (*call)(const void*), const void* work);
}  // namespace detail

/// Calls `work()` on this thread, and on each other thread that becomes free before the call
/// returns here; returns when all calls have returned. `work` distributes the items itself and must
/// not throw. Threads that have not begun are not waited for, so on a busy machine this thread may
/// do all of the work (docs/decisions/019-thread-pool.md).
template <class Work>
void run_on_free_threads(const Work& work) {
  // Other threads trace their part under the name of this thread's span.
  const char* const name = current_span_name();
  const auto traced = [&work, name] {
    const TraceSpan span(name);
    work();
  };
  using Traced = decltype(traced);
  detail::run_on_free_threads([](const void* all) { (*static_cast<Traced*>(all))(); }, &traced);
}

/// Calls `work(begin, end, chunk)` for each chunk of [0, n). Chunks run in any order on any thread,
/// so `work` must write only data of its chunk. Rethrows one exception, if any was thrown.
template <class Work>
void for_chunks(std::size_t n, std::size_t chunk_size, const Work& work) {
  const std::size_t chunks = (n + chunk_size - 1) / chunk_size;
  auto run = [&](std::size_t c) { work(c * chunk_size, std::min(n, (c + 1) * chunk_size), c); };
  if (chunks <= 1) {
    if (chunks == 1) run(0);
    return;
  }
  detail::LoopTimer timer;
  if (timer.counts() || !can_run_parallel()) {
    for (std::size_t c = 0; c < chunks; ++c) timer.run_chunk([&] { run(c); });
    timer.end_loop();
    return;
  }
  std::atomic<std::size_t> next{0};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  run_on_free_threads([&] {
    for (std::size_t c; (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) {
      try {
        run(c);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        failure = std::current_exception();
      }
    }
  });
  if (failure) std::rethrow_exception(failure);
}

/// Calls `find(begin, end, found)` for each chunk of [0, n) and returns the items that the calls
/// append to `found`, in the order of the chunks.
template <class Item, class Find>
std::vector<Item> collect_chunks(std::size_t n, std::size_t chunk_size, const Find& find) {
  std::vector<std::vector<Item>> found((n + chunk_size - 1) / chunk_size);
  for_chunks(n, chunk_size, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    find(begin, end, found[chunk]);
  });
  std::vector<Item> all;
  for (const std::vector<Item>& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace sunder
