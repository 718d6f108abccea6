// Integer hash functions for keys and seeds. Files and states are hashed by xxhash, in engine/io.
#pragma once

#include <cstdint>

namespace sunder {

/// Returns a bijective hash of 64 bits (the finalizer of SplitMix64, Steele et al. 2014).
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Returns the hash of a pair of hashes; the order of the two matters.
constexpr std::uint64_t combine(std::uint64_t a, std::uint64_t b) { return mix(a ^ mix(b)); }

}  // namespace sunder
