// Loops over fixed chunks: what a chunk is never depends on the number of threads, so neither
// does any result. Read first: for_chunks().
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <vector>

#include "engine/base/trace.h"

namespace sunder {

/// Threads used by every parallel loop from now on; 0 means one per processor.
void set_threads(int count);
/// Threads in use.
int threads();
/// Whether more than this thread would work on a loop: not with one thread, nor within a loop.
bool may_share_work();

namespace detail {
void work_together(void (*call)(const void*), const void* work);
}  // namespace detail

/// Calls `work()` on this thread, and on every other that comes while it runs; returns when all
/// calls have. `work` itself hands out what there is to do, and does not throw. Nothing waits for
/// a thread that has not begun: on a busy machine this one does all of it.
template <class Work>
void work_together(const Work& work) {
  // What others do of it is a span of theirs, by the name of ours.
  const char* const name = traced_span();
  const auto traced = [&work, name] {
    const TraceSpan span(name);
    work();
  };
  using Traced = decltype(traced);
  detail::work_together([](const void* all) { (*static_cast<Traced*>(all))(); }, &traced);
}

/// Calls `work(begin, end, chunk)` for the chunks [0, n) is cut into; chunks run in any order on
/// any thread, so `work` writes only what belongs to its chunk. Rethrows one exception, if any.
template <class Work>
void for_chunks(std::size_t n, std::size_t chunk_size, const Work& work) {
  const std::size_t chunks = (n + chunk_size - 1) / chunk_size;
  auto run = [&](std::size_t c) { work(c * chunk_size, std::min(n, (c + 1) * chunk_size), c); };
  if (chunks <= 1 || !may_share_work()) {
    for (std::size_t c = 0; c < chunks; ++c) run(c);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::mutex failing;
  std::exception_ptr failure;
  work_together([&] {
    for (std::size_t c; (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) {
      try {
        run(c);
      } catch (...) {
        const std::lock_guard lock(failing);
        failure = std::current_exception();
      }
    }
  });
  if (failure) std::rethrow_exception(failure);
}

/// Returns the items that `find(begin, end, found)` adds to `found` for each of these chunks, in
/// the order of the chunks.
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
