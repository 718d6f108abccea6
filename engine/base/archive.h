// Archive: the state of objects as bytes. One description of an object's fields both writes and
// reads it, so that the two cannot differ.
//
//   Archive out;                       Archive in(bytes);
//   out(world);                        in(world);
//   std::vector<std::byte> bytes = out.take();
//
// Numbers, enums, vectors and matrices of fixed size, arrays, strings, containers, optional and
// shared objects are known, and classes made of them (engine/base/fields.h). Any other class T has
// a function `void archive(Archive&, T&)` in its own namespace. An object that is shared is written
// once. The bytes are the values alone: padding and addresses do not enter them, so equal states
// have equal bytes. They can be read by the same build of the program on machines of equal byte
// order.
//
// Bytes that are read are not trusted. Counts are held against the bytes that are there, enums have
// to be enumerators, numbers finite (or infinite, where infinity is a value), rotations of unit
// length, and keys ascending. A class says what else has to hold of its fields, such as indices
// within their arrays, in `const char* wrong_field() const`, which returns the name of a field that
// is wrong, or null. It is called once the object has been read, and may rely on the wrong_field()
// of the objects in it.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/fields.h"
#include "engine/base/types.h"

namespace sunder {

class Archive;

namespace internal {

template <class T>
concept HasArchive = requires(Archive& bytes, T& object) {
  archive(bytes, object);
};

template <class T>
concept FindsWrongField = requires(const T& object) {
  { object.wrong_field() } -> std::convertible_to<const char*>;
};

/// Returns the name of a type, as the compiler writes it.
template <class T>
constexpr std::string_view type_name() {
  constexpr std::string_view text = __PRETTY_FUNCTION__, before = "T = ";
  const std::size_t begin = text.find(before) + before.size();
  return text.substr(begin, text.find_first_of(";]", begin) - begin);
}

/// Returns true if a number names an enumerator: the compiler writes others as a cast.
template <class E, E value>
constexpr bool is_enumerator() {
  constexpr std::string_view text = __PRETTY_FUNCTION__;
  const std::size_t begin = text.rfind("value = ") + 8;
  return text.substr(begin, 1) != "(";
}

/// Number of enumerators of an enum, which are 0, 1, ….
template <class E, std::size_t count = 0>
constexpr std::size_t enumerators() {
  if constexpr (is_enumerator<E, static_cast<E>(count)>()) {
    return enumerators<E, count + 1>();
  } else {
    static_assert(count > 0);
    return count;
  }
}

template <class T>
inline constexpr bool kIsQuaternion = false;
template <class S, int O>
inline constexpr bool kIsQuaternion<Eigen::Quaternion<S, O>> = true;

template <class T>
inline constexpr bool kIsEigen = false;
template <class S, int R, int C, int O, int MR, int MC>
inline constexpr bool kIsEigen<Eigen::Matrix<S, R, C, O, MR, MC>> = R > 0 && C > 0;
template <class S, int O>
inline constexpr bool kIsEigen<Eigen::Quaternion<S, O>> = true;

template <class T>
inline constexpr bool kIsArray = std::is_array_v<T>;
template <class T, std::size_t n>
inline constexpr bool kIsArray<std::array<T, n>> = true;

template <class T>
concept Sequence = requires(T& all) {
  all.resize(1);
  all.data();
};
template <class T>
concept Ordered = requires(T& all) {
  typename T::key_compare;
};

template <class T>
constexpr bool is_plain();
template <class... Fields>
constexpr bool are_plain(std::type_identity<std::tuple<Fields&...>>) {
  return (is_plain<Fields>() && ...);
}
template <class... Fields>
constexpr std::size_t sum_of_sizes(std::type_identity<std::tuple<Fields&...>>) {
  return (sizeof(Fields) + ... + 0);
}

/// Returns true if the bytes of a T in memory are its value, and any bytes are a value: it has no
/// pointers, no padding and no bool.
template <class T>
constexpr bool is_plain() {
  if constexpr (std::is_pointer_v<T> || HasArchive<T> || std::is_same_v<T, bool>) {
    return false;  // a damaged bool would be neither true nor false
  } else if constexpr (!std::is_class_v<T> && !std::is_array_v<T>) {
    return !std::is_union_v<T>;
  } else if constexpr (kIsEigen<T>) {
    return sizeof(T) == sizeof(typename T::Scalar) *
                            static_cast<std::size_t>(sizeof(T) / sizeof(typename T::Scalar));
  } else if constexpr (kIsArray<T>) {
    return is_plain<std::remove_cvref_t<decltype(std::declval<T&>()[0])>>();
  } else if constexpr (ListsFields<T> || std::is_aggregate_v<T>) {
    if constexpr (std::is_polymorphic_v<T> || !std::is_trivially_destructible_v<T>) {
      return false;
    } else {
      using Fields = std::type_identity<decltype(fields_of(std::declval<T&>()))>;
      return are_plain(Fields()) && sum_of_sizes(Fields()) == sizeof(T);
    }
  } else {
    return false;
  }
}

template <class T>
constexpr std::size_t least_bytes();
template <class... Fields>
constexpr std::size_t sum_of_least_bytes(std::type_identity<std::tuple<Fields&...>>) {
  return (least_bytes<Fields>() + ... + 0);
}
template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsShared = false;
template <class T>
inline constexpr bool kIsShared<std::shared_ptr<T>> = true;
template <class T>
inline constexpr bool kIsPair = false;
template <class A, class B>
inline constexpr bool kIsPair<std::pair<A, B>> = true;

/// Returns the least number of bytes that a T has in an archive; at least 1, so that the memory
/// that a wrong count takes is in proportion to the bytes that are there.
template <class T>
constexpr std::size_t least_bytes() {
  if constexpr (HasArchive<T> || std::is_same_v<T, bool> || kIsOptional<T> || kIsPair<T>) {
    return 1;
  } else if constexpr (is_plain<T>()) {
    return sizeof(T);
  } else if constexpr (kIsArray<T>) {
    return least_bytes<std::remove_cvref_t<decltype(std::declval<T&>()[0])>>();
  } else if constexpr (kIsShared<T>) {
    return sizeof(std::uint32_t);
  } else if constexpr (Sequence<T> || Ordered<T>) {
    return sizeof(std::uint64_t);
  } else {
    constexpr std::size_t sum =
        sum_of_least_bytes(std::type_identity<decltype(fields_of(std::declval<T&>()))>());
    return sum > 0 ? sum : 1;
  }
}

template <class T>
concept SaysInfinite = requires {
  T::kMayBeInfinite;
};
/// Returns true if numbers that are fields of a T may be infinite. T says so by a static constant
/// kMayBeInfinite.
template <class T>
constexpr bool may_be_infinite() {
  if constexpr (SaysInfinite<T>) {
    return T::kMayBeInfinite;
  } else {
    return false;
  }
}

/// Returns true if some values of the bytes of a plain T are wrong.
template <class T>
constexpr bool has_wrong_values();
template <class... Fields>
constexpr bool have_wrong_values(std::type_identity<std::tuple<Fields&...>>) {
  return (has_wrong_values<Fields>() || ...);
}
template <class T>
constexpr bool has_wrong_values() {
  if constexpr (std::is_same_v<T, std::byte>) {
    return false;
  } else if constexpr (std::is_floating_point_v<T> || std::is_enum_v<T> || FindsWrongField<T>) {
    return true;
  } else if constexpr (kIsEigen<T>) {
    return std::is_floating_point_v<typename T::Scalar>;
  } else if constexpr (kIsArray<T>) {
    return has_wrong_values<std::remove_cvref_t<decltype(std::declval<T&>()[0])>>();
  } else if constexpr (std::is_class_v<T>) {
    return have_wrong_values(std::type_identity<decltype(fields_of(std::declval<T&>()))>());
  } else {
    return false;
  }
}

}  // namespace internal

class Archive {
 public:
  /// Writes.
  Archive() = default;
  /// Reads; `bytes` must outlive the archive.
  explicit Archive(std::span<const std::byte> bytes) : reads_(true), in_(bytes) {}
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// True if objects are read, and so get the values of the bytes.
  bool reads() const { return reads_; }
  /// Writes or reads objects, one after the other. Reading throws InputError at the end of the
  /// bytes.
  template <class... Objects>
  void operator()(Objects&... objects) {
    (one(objects), ...);
  }
  /// Writes or reads a number that may be infinite.
  void infinite(double& number) { one<double, true>(number); }
  /// Throws InputError, naming a field of `T` that is wrong, if `field` is not null.
  template <class T>
  void refuse_field(const char* field) const {
    if (field) refuse(std::string(internal::type_name<T>()) + "::" + field + " is wrong");
  }
  /// Returns what was written.
  std::vector<std::byte> take() { return std::move(out_); }
  /// Throws InputError if bytes are left to read.
  void finish() const {
    if (!in_.empty()) refuse("bytes are left over");
  }

 private:
  /// A field that is being read.
  struct Place {
    std::string_view type;    ///< The class that it is of.
    std::size_t field = 0;    ///< Its number, from 0.
    std::size_t element = 0;  ///< Its element, if it is a sequence.
  };

  [[noreturn]] void refuse(const std::string& what) const {
    std::string where;
    for (const Place& place : places_) {
      where += where.empty() ? " in " : " > ";
      where += std::string(place.type) + ", field " + std::to_string(place.field);
      if (place.element > 0) where += "[" + std::to_string(place.element) + "]";
    }
    std::string text = "the saved state is damaged" + where + ": " + what;
    constexpr std::string_view kOwn = "sunder::";
    for (std::size_t at = 0; (at = text.find(kOwn, at)) != std::string::npos;)
      text.erase(at, kOwn.size());
    throw InputError(text);
  }

  void raw(void* object, std::size_t size) {
    if (!reads_) {
      const auto* first = static_cast<const std::byte*>(object);
      out_.insert(out_.end(), first, first + size);
    } else {
      if (size > in_.size()) refuse("the bytes end");
      if (size > 0) std::memcpy(object, in_.data(), size);
      in_ = in_.subspan(size);
    }
  }
  std::size_t count(std::size_t count, std::size_t least_bytes) {
    std::uint64_t number = count;
    raw(&number, sizeof number);
    if (reads_ && number > in_.size() / least_bytes) refuse("a list is longer than the bytes");
    return static_cast<std::size_t>(number);
  }

  template <class T, bool infinite = false>
  void one(T& object) {
    static_assert(!std::is_pointer_v<T> && !std::is_const_v<T>);
    if constexpr (internal::HasArchive<T>) {
      archive(*this, object);
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = object;
      raw(&byte, sizeof byte);
      if (byte > 1) refuse("a flag is neither true nor false");
      object = byte != 0;
    } else if constexpr (internal::is_plain<T>()) {
      raw(&object, sizeof object);
      if (reads_) validate<T, infinite>(object);
      return;  // with its wrong_field()
    } else if constexpr (internal::kIsArray<T>) {
      for (auto& element : object) one(element);
    } else if constexpr (internal::Sequence<T>) {
      sequence(object);
    } else if constexpr (internal::Ordered<T>) {
      ordered(object);
    } else if constexpr (internal::kIsOptional<T>) {
      optional<infinite>(object);
    } else if constexpr (requires { special(object); }) {
      special(object);
    } else {
      each_field(object, [this](auto& field) {
        one<std::remove_reference_t<decltype(field)>, internal::may_be_infinite<T>()>(field);
      });
    }
    if constexpr (internal::FindsWrongField<T>) {
      if (reads_) refuse_field<T>(object.wrong_field());
    }
  }
  /// Calls `use(field)` for each field of an object, whose place is known meanwhile.
  template <class T, class Use>
  void each_field(T& object, const Use& use) {
    if (reads_) places_.push_back({internal::type_name<std::remove_const_t<T>>()});
    const auto next = [&](auto& field) {
      use(field);
      if (reads_) ++places_.back().field, places_.back().element = 0;
    };
    std::apply([&](auto&... fields) { (next(fields), ...); }, fields_of(object));
    if (reads_) places_.pop_back();
  }
  void note_element(std::size_t element) {
    if (!places_.empty()) places_.back().element = element;
  }
  /// Throws InputError if values that have been read are wrong.
  template <class T, bool infinite = false>
  void validate(const T& object) {
    using std::isfinite, std::isnan;
    if constexpr (!internal::has_wrong_values<T>()) {
      return;
    } else if constexpr (std::is_floating_point_v<T>) {
      if (infinite ? isnan(object) : !isfinite(object)) refuse("a number is not finite");
    } else if constexpr (std::is_enum_v<T>) {
      const auto value = static_cast<std::underlying_type_t<T>>(object);
      if (!(value >= 0 && static_cast<std::size_t>(value) < internal::enumerators<T>()))
        refuse(std::string(internal::type_name<T>()) + " has no value " + std::to_string(+value));
    } else if constexpr (internal::kIsQuaternion<T>) {
      constexpr double kMostError = 1e-3;  // of rotations in single precision, over years of steps
      if (!(std::abs(static_cast<double>(object.squaredNorm()) - 1) < kMostError))
        refuse("a rotation is not of unit length");
    } else if constexpr (internal::kIsEigen<T>) {
      for (Eigen::Index i = 0; i < object.size(); ++i)
        validate<typename T::Scalar, infinite>(object.data()[i]);
    } else if constexpr (internal::kIsArray<T>) {
      for (const auto& element : object)
        validate<std::remove_cvref_t<decltype(element)>, infinite>(element);
    } else {
      each_field(object, [this](const auto& field) {
        validate<std::remove_cvref_t<decltype(field)>, internal::may_be_infinite<T>()>(field);
      });
      if constexpr (internal::FindsWrongField<T>) refuse_field<T>(object.wrong_field());
    }
  }
  template <class T>
  void sequence(T& all) {
    using Element = typename T::value_type;
    constexpr bool plain = internal::is_plain<Element>();
    if (reads_) all.clear();
    all.resize(count(all.size(), internal::least_bytes<Element>()));
    if constexpr (plain) {
      raw(all.data(), all.size() * sizeof(Element));
      if constexpr (!internal::has_wrong_values<Element>()) return;
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (plain && !reads_) break;
      if (reads_) note_element(i);
      if constexpr (plain) {
        validate(all.data()[i]);
      } else {
        one(all.data()[i]);
      }
    }
  }
  template <class T>
  void ordered(T& all) {
    if (!reads_) {
      count(all.size(), 1);
      for (const auto& element : all) one_const(element);
      return;
    }
    all.clear();
    for (std::size_t left = count(0, 1); left > 0; --left) {
      if constexpr (requires { typename T::mapped_type; }) {
        std::pair<typename T::key_type, typename T::mapped_type> element;
        one(element);
        need_ascending(all, element.first);
        all.insert(all.end(), std::move(element));
      } else {
        typename T::key_type element{};
        one(element);
        need_ascending(all, element);
        all.insert(all.end(), std::move(element));
      }
    }
  }
  template <class T>
  void need_ascending(const T& all, const typename T::key_type& next) const {
    if (all.empty()) return;
    const auto last = std::prev(all.end());
    bool ascends = false;
    if constexpr (requires { typename T::mapped_type; }) {
      ascends = all.key_comp()(last->first, next);
    } else {
      ascends = all.key_comp()(*last, next);
    }
    if (!ascends) refuse("keys do not ascend");
  }
  /// Writes an element of a set or map, which is constant.
  template <class T>
  void one_const(const T& element) {
    one(const_cast<T&>(element));
  }
  template <class A, class B>
  void one_const(const std::pair<const A, B>& element) {
    one_const(element.first);
    one_const(element.second);
  }
  template <class A, class B>
  void special(std::pair<A, B>& both) {
    one(both.first);
    one(both.second);
  }
  template <bool infinite, class T>
  void optional(std::optional<T>& object) {
    bool present = object.has_value();
    one(present);
    if (!present) return object.reset();
    if (reads_) object.emplace();
    one<T, infinite>(*object);
  }
  template <class T>
  void special(std::shared_ptr<T>& pointer) {
    using Object = std::remove_const_t<T>;
    static constexpr std::uint32_t kNull = 0xffffffff;
    if (!reads_) {
      if (!pointer) {
        std::uint32_t index = kNull;
        return one(index);
      }
      const auto next = static_cast<std::uint32_t>(written_.size());
      auto [known, is_new] = written_.try_emplace(pointer.get(), next);
      one(known->second);
      if (is_new) one(const_cast<Object&>(*pointer));
      return;
    }
    std::uint32_t index = 0;
    one(index);
    if (index == kNull) return pointer.reset();
    if (index > read_.size()) refuse("a shared object is missing");
    if (index == read_.size()) {
      auto made = std::make_shared<Object>();
      read_.push_back({made, &typeid(Object)});
      one(*made);
      read_[index].complete = true;
    }
    if (*read_[index].type != typeid(Object) || !read_[index].complete)
      refuse("a shared object is of another kind");
    pointer = std::static_pointer_cast<Object>(read_[index].object);
  }

  struct Shared {
    std::shared_ptr<void> object;
    const std::type_info* type = nullptr;
    bool complete = false;  ///< False while it is read: an object does not refer to itself.
  };

  bool reads_ = false;
  std::vector<std::byte> out_;
  std::span<const std::byte> in_;
  std::map<const void*, std::uint32_t> written_;  ///< Index of each shared object.
  std::vector<Shared> read_;
  std::vector<Place> places_;  ///< Fields that are being read, from the outermost.
};

}  // namespace sunder
