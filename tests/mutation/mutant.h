// Functions that mutate.py writes into the lines it changes, so that one build has every mutant:
// the environment variable SUNDER_MUTANT is the number of the active one. An operator is written
// twice, `a + plus<7>() + b`, which keeps its precedence and the evaluation of both operands.
#pragma once
#pragma GCC system_header  // suppresses warnings about comparisons with constants
#pragma GCC diagnostic ignored "-Wparentheses"  // a == b == c, in files that include this one

#include <concepts>
#include <cstdlib>

namespace sunder::mutants {

inline constexpr int kMaxMutants = 4096;  ///< Number of mutants, at most.
inline int chosen = -1;
/// Set to 1 when a mutant's line is run; read by reach.h.
inline unsigned char reached[kMaxMutants];

[[gnu::constructor(101)]] inline void choose() {
  if (const char* number = std::getenv("SUNDER_MUTANT")) chosen = std::atoi(number);
}

#define SUNDER_MUTANT_INLINE [[gnu::always_inline]] inline

template <int k>
SUNDER_MUTANT_INLINE bool on() {
  reached[k] = 1;
  return chosen == k;
}

/// Returns a copy; expressions of Eigen are evaluated, as their operands may not exist later.
template <class T>
SUNDER_MUTANT_INLINE auto value(const T& x) {
  if constexpr (requires { x.eval(); }) {
    return x.eval();
  } else {
    return x;
  }
}

template <class L, class Op>
struct Half {
  const L& left;

  template <class R>
  SUNDER_MUTANT_INLINE friend auto finish(const Half& half, const R& right) {
    using Result = decltype(value(Op::was(half.left, right)));
    if (!on<Op::kNumber>()) return Result(Op::was(half.left, right));
    if constexpr (requires { Result(Op::is(half.left, right)); }) {
      return Result(Op::is(half.left, right));
    } else if constexpr (std::constructible_from<Result, R>) {
      return Result(right);  // no such operator: drop the left operand, ...
    } else {
      return Result(half.left);  // ... or the right one
    }
  }
};

// Defines an operator as a numbered type, `Plus<7>`, with the original and the mutated operation.
#define SUNDER_MUTANT_OPERATOR(Name, OUTER, WAS, IS)                                    \
  template <int k>                                                                      \
  struct Name {                                                                         \
    static constexpr int kNumber = k;                                                   \
    template <class L, class R>                                                         \
    SUNDER_MUTANT_INLINE static auto was(const L& l, const R& r) -> decltype(l WAS r) { \
      return l WAS r;                                                                   \
    }                                                                                   \
    template <class L, class R>                                                         \
    SUNDER_MUTANT_INLINE static auto is(const L& l, const R& r) -> decltype(l IS r) {   \
      return l IS r;                                                                    \
    }                                                                                   \
    template <class L>                                                                  \
    SUNDER_MUTANT_INLINE friend Half<L, Name> operator OUTER(const L& l, Name) {        \
      return {l};                                                                       \
    }                                                                                   \
    template <class L, class R>                                                         \
    SUNDER_MUTANT_INLINE friend auto operator OUTER(Half<L, Name> half, const R& r) {   \
      return finish(half, r);                                                           \
    }                                                                                   \
  };
SUNDER_MUTANT_OPERATOR(PlusToMinus, +, +, -)
SUNDER_MUTANT_OPERATOR(MinusToPlus, -, -, +)
SUNDER_MUTANT_OPERATOR(TimesToOver, *, *, /)
SUNDER_MUTANT_OPERATOR(OverToTimes, /, /, *)
SUNDER_MUTANT_OPERATOR(LessToAtMost, <, <, <=)
SUNDER_MUTANT_OPERATOR(LessToMore, <, <, >)
SUNDER_MUTANT_OPERATOR(MoreToAtLeast, >, >, >=)
SUNDER_MUTANT_OPERATOR(MoreToLess, >, >, <)
SUNDER_MUTANT_OPERATOR(AtMostToLess, <=, <=, <)
SUNDER_MUTANT_OPERATOR(AtMostToAtLeast, <=, <=, >=)
SUNDER_MUTANT_OPERATOR(AtLeastToMore, >=, >=, >)
SUNDER_MUTANT_OPERATOR(AtLeastToAtMost, >=, >=, <=)
SUNDER_MUTANT_OPERATOR(EqualToUnequal, ==, ==, !=)
SUNDER_MUTANT_OPERATOR(UnequalToEqual, !=, !=, ==)
#undef SUNDER_MUTANT_OPERATOR

/// `Negative<7>() * x` is -x, or x if mutant 7 is active.
template <int k>
struct Negative {
  template <class T>
  SUNDER_MUTANT_INLINE friend auto operator*(Negative, const T& x) {
    using Result = decltype(value(-x));
    return on<k>() ? Result(x) : Result(-x);
  }
};

/// `sum<7>(a) += b` is a += b, or a -= b if mutant 7 is active.
template <int k, class T>
struct Sum {
  T& to;
  template <class R>
  SUNDER_MUTANT_INLINE void operator+=(const R& x) {
    if (!on<k>()) {
      to += x;
    } else {
      to -= x;
    }
  }
  template <class R>
  SUNDER_MUTANT_INLINE void operator-=(const R& x) {
    if (!on<k>()) {
      to -= x;
    } else {
      to += x;
    }
  }
};
template <int k, class T>
SUNDER_MUTANT_INLINE Sum<k, T> sum(T& to) {
  return {to};
}

/// `Extreme<7, true>()(a, b)` is std::max(a, b), or a if mutant 7 is active.
template <int k, bool kMax>
struct Extreme {
  template <class T>
  SUNDER_MUTANT_INLINE T operator()(const T& a, const T& b) const {
    if (on<k>()) return a;
    if constexpr (kMax) {
      return a < b ? b : a;
    } else {
      return b < a ? b : a;
    }
  }
};

template <int k>
SUNDER_MUTANT_INLINE bool boolean(bool x) {
  return on<k>() != x;
}
/// Returns a whole number, or the next one if the mutant is active.
template <int k, class T>
SUNDER_MUTANT_INLINE T next(T x) {
  return on<k>() ? static_cast<T>(x + 1) : x;
}
/// Returns a number, or 1.5 times it if the mutant is active.
template <int k, class T>
SUNDER_MUTANT_INLINE T more(T x) {
  return on<k>() ? x * static_cast<T>(1.5) : x;
}

}  // namespace sunder::mutants
