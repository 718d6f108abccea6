// Eight floats at a time: the only place with vector extensions. Every operation is IEEE and
// lane by lane, so a wide kernel gives the bits of a scalar one.
#pragma once

#include <cmath>
#include <cstdint>

namespace sunder::solver {

inline constexpr std::uint32_t kLanes = 8;
typedef float Wide __attribute__((vector_size(32)));
typedef std::int32_t WideInt __attribute__((vector_size(32)));

inline Wide splat(float x) { return Wide{x, x, x, x, x, x, x, x}; }
inline Wide min(Wide a, Wide b) { return a < b ? a : b; }
inline Wide max(Wide a, Wide b) { return a > b ? a : b; }
inline Wide sqrt(Wide x) {
  for (std::uint32_t i = 0; i < kLanes; ++i) x[i] = std::sqrt(x[i]);
  return x;
}

/// Bit i is set where lane i of a comparison is true.
inline std::uint32_t bits(WideInt mask) {
#ifdef __AVX__
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Wide>(mask)));
#else
  std::uint32_t set = 0;
  for (std::uint32_t i = 0; i < kLanes; ++i) set |= mask[i] ? 1u << i : 0u;
  return set;
#endif
}

/// Chunks of eight that hold n items.
constexpr std::uint32_t wide_count(std::uint32_t n) { return (n + kLanes - 1) / kLanes; }

/// Eight vectors.
struct Wide3 {
  Wide x, y, z;
};

inline Wide3 operator+(const Wide3& a, const Wide3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Wide3 operator-(const Wide3& a, const Wide3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Wide3 operator*(const Wide3& a, Wide s) { return {a.x * s, a.y * s, a.z * s}; }
inline Wide dot(const Wide3& a, const Wide3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Wide3 cross(const Wide3& a, const Wide3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Rows become columns, in place.
inline void transpose(Wide (&m)[8]) {
  Wide pairs[8], quads[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(m[i], m[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[i + 1] = __builtin_shufflevector(m[i], m[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int i = 0; i < 8; i += 4) {
    quads[i] = __builtin_shufflevector(pairs[i], pairs[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    quads[i + 1] = __builtin_shufflevector(pairs[i], pairs[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    quads[i + 2] = __builtin_shufflevector(pairs[i + 1], pairs[i + 3], 0, 1, 8, 9, 4, 5, 12, 13);
    quads[i + 3] = __builtin_shufflevector(pairs[i + 1], pairs[i + 3], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (int i = 0; i < 4; ++i) {
    m[i] = __builtin_shufflevector(quads[i], quads[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    m[i + 4] = __builtin_shufflevector(quads[i], quads[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace sunder::solver
