// Loops over fixed chunks: what a chunk is never depends on the number of threads, so neither
// does any result.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>

#include <omp.h>

namespace sunder {

/// Threads used by every parallel loop from now on; 0 means one per processor.
void set_threads(int count);
/// Threads in use.
int threads();

/// Calls `work(begin, end, chunk)` for the chunks [0, n) is cut into; chunks run in any order on
/// any thread, so `work` writes only what belongs to its chunk. Rethrows one exception, if any.
template <class Work>
void for_chunks(std::size_t n, std::size_t chunk_size, const Work& work) {
  const std::size_t chunks = (n + chunk_size - 1) / chunk_size;
  auto run = [&](std::size_t c) { work(c * chunk_size, std::min(n, (c + 1) * chunk_size), c); };
  if (chunks <= 1 || threads() == 1 || omp_in_parallel()) {
    for (std::size_t c = 0; c < chunks; ++c) run(c);
    return;
  }
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads())
  for (std::size_t c = 0; c < chunks; ++c) {
    try {
      run(c);
    } catch (...) {
#pragma omp critical(sunder_for_chunks)
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sunder
