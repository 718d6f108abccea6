// Vectors of several floats by compiler vector extensions, which no other file uses. Every
// operation is IEEE and acts on each lane alone, so a wide kernel gives the same bits as a scalar
// one.
//
// Collision uses eight lanes (Wide); the contact solver is compiled for 1, 4, 8 and 16 lanes, each
// with its own instruction set. All functions are therefore force-inlined: the linker would merge
// their copies, and the one it keeps may use instructions that this processor lacks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#define SUNDER_INLINE [[gnu::always_inline]] inline

namespace sunder::solver {

namespace detail {
template <std::uint32_t lanes>
struct Vectors {
  typedef float Float __attribute__((vector_size(4 * lanes)));
  typedef std::int32_t Int __attribute__((vector_size(4 * lanes)));
};

/// A vector of one lane. GCC 12 miscompiles its own vectors of one float at -O2 (restitution had no
/// effect; correct at -O1 or without -ftree-vrp).
struct One {
  float x;

  SUNDER_INLINE float& operator[](std::uint32_t) { return x; }
  SUNDER_INLINE float operator[](std::uint32_t) const { return x; }
  SUNDER_INLINE One operator-() const { return {-x}; }
  SUNDER_INLINE One& operator+=(One b) { return x += b.x, *this; }
  SUNDER_INLINE One& operator*=(One b) { return x *= b.x, *this; }
  SUNDER_INLINE friend One operator+(One a, One b) { return {a.x + b.x}; }
  SUNDER_INLINE friend One operator-(One a, One b) { return {a.x - b.x}; }
  SUNDER_INLINE friend One operator*(One a, One b) { return {a.x * b.x}; }
  SUNDER_INLINE friend One operator/(One a, One b) { return {a.x / b.x}; }
  SUNDER_INLINE friend One operator+(float a, One b) { return {a + b.x}; }
  SUNDER_INLINE friend One operator-(float a, One b) { return {a - b.x}; }
  SUNDER_INLINE friend One operator*(float a, One b) { return {a * b.x}; }
  SUNDER_INLINE friend One operator/(float a, One b) { return {a / b.x}; }
  SUNDER_INLINE friend One operator*(One a, float b) { return {a.x * b}; }
  SUNDER_INLINE friend bool operator<(One a, One b) { return a.x < b.x; }
  SUNDER_INLINE friend bool operator>(One a, One b) { return a.x > b.x; }
};
template <>
struct Vectors<1> {
  using Float = One;
};
}  // namespace detail

template <std::uint32_t lanes>
using WideOf = typename detail::Vectors<lanes>::Float;

inline constexpr std::uint32_t kLanes = 8;
using Wide = WideOf<kLanes>;
using WideInt = detail::Vectors<kLanes>::Int;

template <class V>
inline constexpr std::uint32_t kLanesOf = sizeof(V) / sizeof(float);

template <class V = Wide>
SUNDER_INLINE V splat(float x) {
  return x - V{};
}
/// Loads eight consecutive floats from an unaligned address.
SUNDER_INLINE Wide load(const float* from) {
  typedef float Floats __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
  return *reinterpret_cast<const Floats*>(from);
}
template <class V>
SUNDER_INLINE V min(V a, V b) {
  return a < b ? a : b;
}
template <class V>
SUNDER_INLINE V max(V a, V b) {
  return a > b ? a : b;
}
/// Returns the least of eight lanes.
SUNDER_INLINE float min_lane(Wide v) {
  v = min(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
  v = min(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
  v = min(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
  return v[0];
}
SUNDER_INLINE float max_lane(Wide v) { return -min_lane(-v); }
template <class V>
SUNDER_INLINE V sqrt(V x) {
  for (std::uint32_t i = 0; i < kLanesOf<V>; ++i) x[i] = __builtin_sqrtf(x[i]);
  return x;
}

/// Returns a bit mask in which bit i is set if lane i of a comparison is true.
SUNDER_INLINE std::uint32_t bits(WideInt mask) {
#ifdef __AVX__
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Wide>(mask)));
#else
  std::uint32_t set = 0;
  for (std::uint32_t i = 0; i < kLanes; ++i) set |= mask[i] ? 1u << i : 0u;
  return set;
#endif
}
/// Returns the bit mask of a comparison with any number of lanes.
template <class Mask>
SUNDER_INLINE std::uint32_t bits(Mask mask) {
  if constexpr (std::is_integral_v<Mask>) {
    return mask != 0 ? 1 : 0;  // one lane
  } else {
    std::uint32_t set = 0;
    for (std::uint32_t i = 0; i < sizeof(Mask) / sizeof(std::int32_t); ++i)
      set |= static_cast<std::uint32_t>(mask[i]) & 1u << i;
    return set;
  }
}
/// Returns true if any lane of a comparison is true.
template <class Mask>
SUNDER_INLINE bool any(Mask mask) {
  if constexpr (std::is_integral_v<Mask>) {
    return mask != 0;  // one lane
  } else {
    std::int32_t set = 0;
    for (std::uint32_t i = 0; i < sizeof(Mask) / sizeof(std::int32_t); ++i) set |= mask[i];
    return set != 0;
  }
}

/// Returns the number of groups of eight lanes that hold n items.
constexpr std::uint32_t lane_groups(std::uint32_t n) { return (n + kLanes - 1) / kLanes; }

/// A vector in three dimensions per lane.
template <class V>
struct Triple {
  V x, y, z;
};
template <std::uint32_t lanes>
using Wide3Of = Triple<WideOf<lanes>>;
using Wide3 = Triple<Wide>;

template <class V>
SUNDER_INLINE Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
SUNDER_INLINE Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
SUNDER_INLINE Triple<V> operator*(const Triple<V>& a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class V>
SUNDER_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
SUNDER_INLINE Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

namespace detail {

typedef float Simd4 __attribute__((vector_size(16), may_alias));

/// Loads four floats at `offset` of rows 0, 4, 8 and so on into consecutive lanes.
template <class V>
SUNDER_INLINE V load_quads(const float* const* row, std::uint32_t offset) {
  auto quad = [&](int i) { return *reinterpret_cast<const Simd4*>(row[i] + offset); };
  if constexpr (kLanesOf<V> == 4) {
    return quad(0);
  } else if constexpr (kLanesOf<V> == 8) {
    return __builtin_shufflevector(quad(0), quad(4), 0, 1, 2, 3, 4, 5, 6, 7);
  } else {
    const Wide low = __builtin_shufflevector(quad(0), quad(4), 0, 1, 2, 3, 4, 5, 6, 7);
    const Wide high = __builtin_shufflevector(quad(8), quad(12), 0, 1, 2, 3, 4, 5, 6, 7);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }
}
template <class V>
SUNDER_INLINE void store_quads(V v, float* const* row, std::uint32_t offset) {
  auto put = [&](std::uint32_t i, Simd4 quad) {
    *reinterpret_cast<Simd4*>(row[i] + offset) = quad;
  };
  if constexpr (kLanesOf<V> == 4) {
    put(0, v);
  } else {
    put(0, __builtin_shufflevector(v, v, 0, 1, 2, 3));
    put(4, __builtin_shufflevector(v, v, 4, 5, 6, 7));
    if constexpr (kLanesOf<V> == 16) {
      put(8, __builtin_shufflevector(v, v, 8, 9, 10, 11));
      put(12, __builtin_shufflevector(v, v, 12, 13, 14, 15));
    }
  }
}

/// Shuffles every four lanes alike: choices 0 to 3 are lanes of a, 4 to 7 lanes of b.
template <int... choice, class V, std::uint32_t... lane>
SUNDER_INLINE V shuffle_fours(V a, V b, std::integer_sequence<std::uint32_t, lane...>) {
  constexpr int kChoice[4] = {choice...};
  constexpr int kFromB = static_cast<int>(kLanesOf<V>) - 4;
  return __builtin_shufflevector(a, b,
                                 (kChoice[lane % 4] + (kChoice[lane % 4] < 4 ? 0 : kFromB) +
                                  static_cast<int>(lane / 4 * 4))...);
}
template <int... choice, class V>
SUNDER_INLINE V shuffle_fours(V a, V b) {
  return shuffle_fours<choice...>(a, b, std::make_integer_sequence<std::uint32_t, kLanesOf<V>>());
}

/// Transposes each block of four by four lanes.
template <class V>
SUNDER_INLINE void transpose(V& a, V& b, V& c, V& d) {
  const V ab_low = shuffle_fours<0, 4, 1, 5>(a, b), ab_high = shuffle_fours<2, 6, 3, 7>(a, b);
  const V cd_low = shuffle_fours<0, 4, 1, 5>(c, d), cd_high = shuffle_fours<2, 6, 3, 7>(c, d);
  a = shuffle_fours<0, 1, 4, 5>(ab_low, cd_low), b = shuffle_fours<2, 3, 6, 7>(ab_low, cd_low);
  c = shuffle_fours<0, 1, 4, 5>(ab_high, cd_high), d = shuffle_fours<2, 3, 6, 7>(ab_high, cd_high);
}

}  // namespace detail

/// Linear and angular part of a motion, one body per lane.
template <class V>
struct Motion6 {
  Triple<V> linear, angular;
};

/// Loads eight floats at `offset` of each row: lane l of v[i] is row[l][offset + i].
template <class V>
SUNDER_INLINE void load_eight(const float* const* row, std::uint32_t offset, V (&v)[8]) {
  if constexpr (kLanesOf<V> == 1) {
    for (std::uint32_t i = 0; i < 8; ++i) v[i] = V{row[0][offset + i]};
  } else {
    for (std::uint32_t i = 0; i < 8; ++i)
      v[i] = detail::load_quads<V>(row + i % 4, offset + i / 4 * 4);
    detail::transpose(v[0], v[1], v[2], v[3]);
    detail::transpose(v[4], v[5], v[6], v[7]);
  }
}
/// Stores to row[l][offset + i] lane l of v[i]: the inverse of load_eight(). Overwrites v.
template <class V>
SUNDER_INLINE void store_eight(V (&v)[8], float* const* row, std::uint32_t offset) {
  if constexpr (kLanesOf<V> == 1) {
    for (std::uint32_t i = 0; i < 8; ++i) row[0][offset + i] = v[i][0];
  } else {
    detail::transpose(v[0], v[1], v[2], v[3]);
    detail::transpose(v[4], v[5], v[6], v[7]);
    for (std::uint32_t i = 0; i < 8; ++i)
      detail::store_quads(v[i], row + i % 4, offset + i / 4 * 4);
  }
}

/// Loads the first six floats of each row, one row per lane.
template <class V>
SUNDER_INLINE Motion6<V> load_rows(const float* const* row) {
  V v[8];
  load_eight(row, 0, v);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}
/// Stores a motion to rows of eight floats, one row per lane; the last two floats become 0.
template <class V>
SUNDER_INLINE void store_rows(const Motion6<V>& m, float* const* row) {
  V v[8] = {m.linear.x, m.linear.y, m.linear.z, m.angular.x, m.angular.y, m.angular.z, V{}, V{}};
  store_eight(v, row, 0);
}

}  // namespace sunder::solver
