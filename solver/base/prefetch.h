// Prefetching of memory into the cache.
#pragma once

#include <cstddef>
#include <span>

namespace sunder::solver {

inline constexpr std::size_t kCacheLine = 64;

/// Prefetches the first cache lines of an array, at most `lines`.
template <class T>
void prefetch(std::span<const T> items, std::size_t lines) {
  const char* const start = reinterpret_cast<const char*>(items.data());
  const std::size_t bytes = items.size_bytes();
  for (std::size_t at = 0; at < bytes && at < lines * kCacheLine; at += kCacheLine)
    __builtin_prefetch(start + at);
}
template <class T>
void prefetch(const T& item) {
  prefetch(std::span(&item, 1), (sizeof(T) + kCacheLine - 1) / kCacheLine);
}

}  // namespace sunder::solver
