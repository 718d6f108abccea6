// The fields of a class as a tuple of references, so that code for all fields of any class is
// written once (engine/base/archive.h).
//
// An aggregate needs nothing. Another class lists its fields itself, as a member:
//   static auto fields(auto& self) { return std::tie(self.first_, self.second_); }
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>

namespace sunder {

template <class T>
concept ListsFields = requires(T& object) {
  T::fields(object);
};

namespace internal {

// C++20 cannot expand a pack to `{}` or to structured bindings, so both are lists here.

#define SUNDER_EMPTY_1 \
  {}
#define SUNDER_EMPTY_2 \
  SUNDER_EMPTY_1, {}
#define SUNDER_EMPTY_3 \
  SUNDER_EMPTY_2, {}
#define SUNDER_EMPTY_4 \
  SUNDER_EMPTY_3, {}
#define SUNDER_EMPTY_5 \
  SUNDER_EMPTY_4, {}
#define SUNDER_EMPTY_6 \
  SUNDER_EMPTY_5, {}
#define SUNDER_EMPTY_7 \
  SUNDER_EMPTY_6, {}
#define SUNDER_EMPTY_8 \
  SUNDER_EMPTY_7, {}
#define SUNDER_EMPTY_9 \
  SUNDER_EMPTY_8, {}
#define SUNDER_EMPTY_10 \
  SUNDER_EMPTY_9, {}
#define SUNDER_EMPTY_11 \
  SUNDER_EMPTY_10, {}
#define SUNDER_EMPTY_12 \
  SUNDER_EMPTY_11, {}
#define SUNDER_EMPTY_13 \
  SUNDER_EMPTY_12, {}
#define SUNDER_EMPTY_14 \
  SUNDER_EMPTY_13, {}
#define SUNDER_EMPTY_15 \
  SUNDER_EMPTY_14, {}
#define SUNDER_EMPTY_16 \
  SUNDER_EMPTY_15, {}
#define SUNDER_EMPTY_17 \
  SUNDER_EMPTY_16, {}
#define SUNDER_EMPTY_18 \
  SUNDER_EMPTY_17, {}
#define SUNDER_EMPTY_19 \
  SUNDER_EMPTY_18, {}
#define SUNDER_EMPTY_20 \
  SUNDER_EMPTY_19, {}
#define SUNDER_EMPTY_21 \
  SUNDER_EMPTY_20, {}
#define SUNDER_EMPTY_22 \
  SUNDER_EMPTY_21, {}
#define SUNDER_EMPTY_23 \
  SUNDER_EMPTY_22, {}
#define SUNDER_EMPTY_24 \
  SUNDER_EMPTY_23, {}
#define SUNDER_EMPTY_25 \
  SUNDER_EMPTY_24, {}
#define SUNDER_EMPTY_26 \
  SUNDER_EMPTY_25, {}
#define SUNDER_EMPTY_27 \
  SUNDER_EMPTY_26, {}
#define SUNDER_EMPTY_28 \
  SUNDER_EMPTY_27, {}
#define SUNDER_EMPTY_29 \
  SUNDER_EMPTY_28, {}
#define SUNDER_EMPTY_30 \
  SUNDER_EMPTY_29, {}
#define SUNDER_EMPTY_31 \
  SUNDER_EMPTY_30, {}
#define SUNDER_EMPTY_32 \
  SUNDER_EMPTY_31, {}
#define SUNDER_EMPTY_33 \
  SUNDER_EMPTY_32, {}
#define SUNDER_EMPTY_34 \
  SUNDER_EMPTY_33, {}
#define SUNDER_EMPTY_35 \
  SUNDER_EMPTY_34, {}
#define SUNDER_EMPTY_36 \
  SUNDER_EMPTY_35, {}
#define SUNDER_EMPTY_37 \
  SUNDER_EMPTY_36, {}
#define SUNDER_EMPTY_38 \
  SUNDER_EMPTY_37, {}
#define SUNDER_EMPTY_39 \
  SUNDER_EMPTY_38, {}
#define SUNDER_EMPTY_40 \
  SUNDER_EMPTY_39, {}
#define SUNDER_NAMES_1 f1
#define SUNDER_NAMES_2 SUNDER_NAMES_1, f2
#define SUNDER_NAMES_3 SUNDER_NAMES_2, f3
#define SUNDER_NAMES_4 SUNDER_NAMES_3, f4
#define SUNDER_NAMES_5 SUNDER_NAMES_4, f5
#define SUNDER_NAMES_6 SUNDER_NAMES_5, f6
#define SUNDER_NAMES_7 SUNDER_NAMES_6, f7
#define SUNDER_NAMES_8 SUNDER_NAMES_7, f8
#define SUNDER_NAMES_9 SUNDER_NAMES_8, f9
#define SUNDER_NAMES_10 SUNDER_NAMES_9, f10
#define SUNDER_NAMES_11 SUNDER_NAMES_10, f11
#define SUNDER_NAMES_12 SUNDER_NAMES_11, f12
#define SUNDER_NAMES_13 SUNDER_NAMES_12, f13
#define SUNDER_NAMES_14 SUNDER_NAMES_13, f14
#define SUNDER_NAMES_15 SUNDER_NAMES_14, f15
#define SUNDER_NAMES_16 SUNDER_NAMES_15, f16
#define SUNDER_NAMES_17 SUNDER_NAMES_16, f17
#define SUNDER_NAMES_18 SUNDER_NAMES_17, f18
#define SUNDER_NAMES_19 SUNDER_NAMES_18, f19
#define SUNDER_NAMES_20 SUNDER_NAMES_19, f20
#define SUNDER_NAMES_21 SUNDER_NAMES_20, f21
#define SUNDER_NAMES_22 SUNDER_NAMES_21, f22
#define SUNDER_NAMES_23 SUNDER_NAMES_22, f23
#define SUNDER_NAMES_24 SUNDER_NAMES_23, f24
#define SUNDER_NAMES_25 SUNDER_NAMES_24, f25
#define SUNDER_NAMES_26 SUNDER_NAMES_25, f26
#define SUNDER_NAMES_27 SUNDER_NAMES_26, f27
#define SUNDER_NAMES_28 SUNDER_NAMES_27, f28
#define SUNDER_NAMES_29 SUNDER_NAMES_28, f29
#define SUNDER_NAMES_30 SUNDER_NAMES_29, f30
#define SUNDER_NAMES_31 SUNDER_NAMES_30, f31
#define SUNDER_NAMES_32 SUNDER_NAMES_31, f32
#define SUNDER_NAMES_33 SUNDER_NAMES_32, f33
#define SUNDER_NAMES_34 SUNDER_NAMES_33, f34
#define SUNDER_NAMES_35 SUNDER_NAMES_34, f35
#define SUNDER_NAMES_36 SUNDER_NAMES_35, f36
#define SUNDER_NAMES_37 SUNDER_NAMES_36, f37
#define SUNDER_NAMES_38 SUNDER_NAMES_37, f38
#define SUNDER_NAMES_39 SUNDER_NAMES_38, f39
#define SUNDER_NAMES_40 SUNDER_NAMES_39, f40

/// Returns the fields of an aggregate of at most 40: the greatest number of initializers that it
/// takes.
template <class T>
constexpr auto aggregate_fields(T& object) {
  using Plain = std::remove_const_t<T>;
  static_assert(std::is_aggregate_v<Plain>, "list the class's fields: see the top of fields.h");
#define SUNDER_FIELDS(count)                                 \
  if constexpr (requires { Plain{SUNDER_EMPTY_##count}; }) { \
    auto& [SUNDER_NAMES_##count] = object;                   \
    return std::tie(SUNDER_NAMES_##count);                   \
  } else

  SUNDER_FIELDS(40)
  SUNDER_FIELDS(39)
  SUNDER_FIELDS(38)
  SUNDER_FIELDS(37)
  SUNDER_FIELDS(36)
  SUNDER_FIELDS(35)
  SUNDER_FIELDS(34)
  SUNDER_FIELDS(33)
  SUNDER_FIELDS(32)
  SUNDER_FIELDS(31)
  SUNDER_FIELDS(30)
  SUNDER_FIELDS(29)
  SUNDER_FIELDS(28)
  SUNDER_FIELDS(27)
  SUNDER_FIELDS(26)
  SUNDER_FIELDS(25)
  SUNDER_FIELDS(24)
  SUNDER_FIELDS(23)
  SUNDER_FIELDS(22)
  SUNDER_FIELDS(21)
  SUNDER_FIELDS(20)
  SUNDER_FIELDS(19)
  SUNDER_FIELDS(18)
  SUNDER_FIELDS(17)
  SUNDER_FIELDS(16)
  SUNDER_FIELDS(15)
  SUNDER_FIELDS(14)
  SUNDER_FIELDS(13)
  SUNDER_FIELDS(12)
  SUNDER_FIELDS(11)
  SUNDER_FIELDS(10)
  SUNDER_FIELDS(9)
  SUNDER_FIELDS(8)
  SUNDER_FIELDS(7)
  SUNDER_FIELDS(6)
  SUNDER_FIELDS(5)
  SUNDER_FIELDS(4)
  SUNDER_FIELDS(3)
  SUNDER_FIELDS(2)
  SUNDER_FIELDS(1) {
    static_assert(std::is_empty_v<Plain>, "the class has too many fields: see fields.h");
    return std::tuple<>();
  }
#undef SUNDER_FIELDS
}

#undef SUNDER_EMPTY_1
#undef SUNDER_NAMES_1
#undef SUNDER_EMPTY_2
#undef SUNDER_NAMES_2
#undef SUNDER_EMPTY_3
#undef SUNDER_NAMES_3
#undef SUNDER_EMPTY_4
#undef SUNDER_NAMES_4
#undef SUNDER_EMPTY_5
#undef SUNDER_NAMES_5
#undef SUNDER_EMPTY_6
#undef SUNDER_NAMES_6
#undef SUNDER_EMPTY_7
#undef SUNDER_NAMES_7
#undef SUNDER_EMPTY_8
#undef SUNDER_NAMES_8
#undef SUNDER_EMPTY_9
#undef SUNDER_NAMES_9
#undef SUNDER_EMPTY_10
#undef SUNDER_NAMES_10
#undef SUNDER_EMPTY_11
#undef SUNDER_NAMES_11
#undef SUNDER_EMPTY_12
#undef SUNDER_NAMES_12
#undef SUNDER_EMPTY_13
#undef SUNDER_NAMES_13
#undef SUNDER_EMPTY_14
#undef SUNDER_NAMES_14
#undef SUNDER_EMPTY_15
#undef SUNDER_NAMES_15
#undef SUNDER_EMPTY_16
#undef SUNDER_NAMES_16
#undef SUNDER_EMPTY_17
#undef SUNDER_NAMES_17
#undef SUNDER_EMPTY_18
#undef SUNDER_NAMES_18
#undef SUNDER_EMPTY_19
#undef SUNDER_NAMES_19
#undef SUNDER_EMPTY_20
#undef SUNDER_NAMES_20
#undef SUNDER_EMPTY_21
#undef SUNDER_NAMES_21
#undef SUNDER_EMPTY_22
#undef SUNDER_NAMES_22
#undef SUNDER_EMPTY_23
#undef SUNDER_NAMES_23
#undef SUNDER_EMPTY_24
#undef SUNDER_NAMES_24
#undef SUNDER_EMPTY_25
#undef SUNDER_NAMES_25
#undef SUNDER_EMPTY_26
#undef SUNDER_NAMES_26
#undef SUNDER_EMPTY_27
#undef SUNDER_NAMES_27
#undef SUNDER_EMPTY_28
#undef SUNDER_NAMES_28
#undef SUNDER_EMPTY_29
#undef SUNDER_NAMES_29
#undef SUNDER_EMPTY_30
#undef SUNDER_NAMES_30
#undef SUNDER_EMPTY_31
#undef SUNDER_NAMES_31
#undef SUNDER_EMPTY_32
#undef SUNDER_NAMES_32
#undef SUNDER_EMPTY_33
#undef SUNDER_NAMES_33
#undef SUNDER_EMPTY_34
#undef SUNDER_NAMES_34
#undef SUNDER_EMPTY_35
#undef SUNDER_NAMES_35
#undef SUNDER_EMPTY_36
#undef SUNDER_NAMES_36
#undef SUNDER_EMPTY_37
#undef SUNDER_NAMES_37
#undef SUNDER_EMPTY_38
#undef SUNDER_NAMES_38
#undef SUNDER_EMPTY_39
#undef SUNDER_NAMES_39
#undef SUNDER_EMPTY_40
#undef SUNDER_NAMES_40

}  // namespace internal

/// Returns references to all fields of an object, in their order.
template <class T>
constexpr auto fields_of(T& object) {
  if constexpr (ListsFields<std::remove_const_t<T>>)
    return std::remove_const_t<T>::fields(object);
  else
    return internal::aggregate_fields(object);
}

}  // namespace sunder
