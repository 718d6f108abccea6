// Integer mixing for keys and seeds. (File and state hashes are xxhash, in engine/io.)
#pragma once

#include <cstdint>

namespace sunder {

/// A bijective mix of 64 bits (SplitMix64 finaliser, Steele et al. 2014).
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Folds `b` into `a`; order matters.
constexpr std::uint64_t combine(std::uint64_t a, std::uint64_t b) { return mix(a ^ mix(b)); }

}  // namespace sunder
