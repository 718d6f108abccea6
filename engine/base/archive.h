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
// have equal bytes. They can be read by the same version of the program on machines of equal byte
// order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
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
  /// Returns what was written.
  std::vector<std::byte> take() { return std::move(out_); }
  /// Throws InputError if bytes are left to read.
  void finish() const {
    if (!in_.empty()) refuse();
  }

 private:
  [[noreturn]] static void refuse() { throw InputError("the saved state is damaged"); }

  void raw(void* object, std::size_t size) {
    if (!reads_) {
      const auto* first = static_cast<const std::byte*>(object);
      out_.insert(out_.end(), first, first + size);
    } else {
      if (size > in_.size()) refuse();
      if (size > 0) std::memcpy(object, in_.data(), size);
      in_ = in_.subspan(size);
    }
  }
  std::size_t count(std::size_t count, std::size_t least_bytes) {
    std::uint64_t number = count;
    raw(&number, sizeof number);
    if (reads_ && number > in_.size() / least_bytes) refuse();
    return static_cast<std::size_t>(number);
  }

  template <class T>
  void one(T& object) {
    static_assert(!std::is_pointer_v<T> && !std::is_const_v<T>);
    if constexpr (internal::HasArchive<T>) {
      archive(*this, object);
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = object;
      raw(&byte, sizeof byte);
      if (byte > 1) refuse();
      object = byte != 0;
    } else if constexpr (internal::is_plain<T>()) {
      raw(&object, sizeof object);
    } else if constexpr (internal::kIsArray<T>) {
      for (auto& element : object) one(element);
    } else if constexpr (internal::Sequence<T>) {
      sequence(object);
    } else if constexpr (internal::Ordered<T>) {
      ordered(object);
    } else if constexpr (requires { special(object); }) {
      special(object);
    } else {
      std::apply([this](auto&... fields) { (one(fields), ...); }, fields_of(object));
    }
  }
  template <class T>
  void sequence(T& all) {
    using Element = typename T::value_type;
    constexpr bool plain = internal::is_plain<Element>();
    if (reads_) all.clear();
    all.resize(count(all.size(), plain ? sizeof(Element) : 1));
    if constexpr (plain) {
      raw(all.data(), all.size() * sizeof(Element));
    } else {
      for (Element& element : all) one(element);
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
        all.insert(all.end(), std::move(element));
      } else {
        typename T::key_type element{};
        one(element);
        all.insert(all.end(), std::move(element));
      }
    }
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
  template <class T>
  void special(std::optional<T>& object) {
    bool present = object.has_value();
    one(present);
    if (!present) return object.reset();
    if (reads_) object.emplace();
    one(*object);
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
    if (index > read_.size()) refuse();
    if (index == read_.size()) {
      auto made = std::make_shared<Object>();
      read_.push_back({made, &typeid(Object)});
      one(*made);
      read_[index].complete = true;
    }
    if (*read_[index].type != typeid(Object) || !read_[index].complete) refuse();
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
};

}  // namespace sunder
