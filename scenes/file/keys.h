// What a table of a scene file may say: one declaration a key, from which come the reader, its
// errors and the reference in README.md.
//
// Read first: kGroundKeys in schema.cpp for what a declaration looks like, then Keys::read().
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/types.h"
#include "engine/model/material.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// A material by name; the reader looks the index up.
struct MaterialRef {
  std::string name;
  MaterialIndex index;
};

/// A number of something, or a file that lists it.
struct CountOrFile {
  std::uint32_t count = 0;  ///< 0: what is usual.
  std::string file;
};

/// Numbers in rows of equal length.
struct HeightGrid {
  std::size_t columns = 0;
  std::vector<double> values;  ///< Row after row.

  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// Allowed values, both ends included; of every component of a vector.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
};

/// One key: its name, where it is stored and what is allowed.
struct Key {
  enum class Kind {  // those before kChoice as in detail::FieldTypes
    kBool,
    kInteger,   ///< int
    kCount,     ///< std::uint32_t
    kSeed,      ///< std::uint64_t
    kNumber,    ///< double
    kVector,    ///< Vec3
    kColor,     ///< Vec3f
    kText,      ///< std::string
    kMaterial,  ///< MaterialRef
    kFit,       ///< Fit
    kCountOrFile,
    kOutline,  ///< std::vector<Vec2>
    kGrid,     ///< HeightGrid
    kChoice,   ///< an enumeration
    kTable,    ///< read by whoever asks for it: allowed, and documented elsewhere
  };

  std::string_view name;  ///< Ending in _rad: may also be given in degrees, ending in _deg.
  Kind kind = Kind::kTable;
  std::string_view unit;
  Range range;
  std::string_view help;
  bool required = false;
  bool optional = false;  ///< No default: absent means absent.
  std::span<const std::string_view> choices;
  void* (*field)(void* object) = nullptr;  ///< Makes an optional one present.
  void (*choose)(void* object, std::size_t choice) = nullptr;
  std::size_t (*chosen)(const void* object) = nullptr;

  Key must() const {
    Key key = *this;
    key.required = true;
    return key;
  }
};

namespace detail {

template <class T>
struct MemberOf;
template <class Owner, class Field>
struct MemberOf<Field Owner::*> {
  using owner = Owner;
  using field = Field;
};
template <class T>
struct Unwrapped {
  using type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using type = T;
};

/// What keys are stored in, in the order of their kinds.
template <class... T>
struct TypeList {};
using FieldTypes =
    TypeList<bool, int, std::uint32_t, std::uint64_t, double, Vec3, Vec3f, std::string, MaterialRef,
             Fit, CountOrFile, std::vector<Vec2>, HeightGrid>;

template <class Field, class... T>
constexpr Key::Kind kind_of(TypeList<T...>) {
  int kind = 0;
  static_assert((std::is_same_v<Field, T> || ...) || std::is_enum_v<Field>);
  ((std::is_same_v<Field, T> || (++kind, false)) || ...);
  return static_cast<Key::Kind>(kind);  // after all of them comes kChoice
}

template <class Use, class... T>
void use_field(Key::Kind kind, void* field, const Use& use, TypeList<T...>) {
  int i = 0;
  ((i++ == static_cast<int>(kind) ? use(*static_cast<T*>(field)) : void()), ...);
}

}  // namespace detail

/// A key stored in a member; its default is what the member of a fresh object holds.
template <auto member>
Key key(std::string_view name, std::string_view unit, Range range, std::string_view help) {
  using Owner = typename detail::MemberOf<decltype(member)>::owner;
  using Field = typename detail::MemberOf<decltype(member)>::field;
  using Bare = typename detail::Unwrapped<Field>::type;
  Key key;
  key.name = name;
  key.kind = detail::kind_of<Bare>(detail::FieldTypes());
  key.unit = unit;
  key.range = range;
  key.help = help;
  key.optional = !std::is_same_v<Field, Bare>;
  key.field = [](void* object) -> void* {
    Field& field = static_cast<Owner*>(object)->*member;
    if constexpr (std::is_same_v<Field, Bare>) {
      return &field;
    } else {
      return &field.emplace();
    }
  };
  return key;
}

template <auto member>
Key key(std::string_view name, std::string_view help) {
  return key<member>(name, "", Range(), help);
}

/// A key that names a value of an enumeration; `choices` in the enumeration's order.
template <auto member>
Key choice(std::string_view name, std::span<const std::string_view> choices,
           std::string_view help) {
  using Owner = typename detail::MemberOf<decltype(member)>::owner;
  using Enum = typename detail::MemberOf<decltype(member)>::field;
  Key key = scenes::key<member>(name, help);
  key.choices = choices;
  key.choose = [](void* object, std::size_t index) {
    static_cast<Owner*>(object)->*member = static_cast<Enum>(index);
  };
  key.chosen = [](const void* object) {
    return static_cast<std::size_t>(static_cast<const Owner*>(object)->*member);
  };
  return key;
}

/// Calls `use` with what a key of `object` is stored in; choices and tables are passed over.
template <class Use>
void use_field(const Key& key, void* object, const Use& use) {
  if (key.kind >= Key::Kind::kChoice) return;
  detail::use_field(key.kind, key.field(object), use, detail::FieldTypes());
}

/// A key that holds a table (or an array of them) with keys of its own.
inline Key table_key(std::string_view name, std::string_view help) {
  Key key;
  key.name = name;
  key.help = help;
  return key;
}

/// The keys of one table, stored in a T.
template <class T>
struct Keys {
  std::string_view table;  ///< As in "[ground]".
  std::vector<Key> keys;
};

/// Throws InputError for a key that none of `allowed` lists, naming the nearest one.
void check_known(const Value& table, std::string_view name,
                 std::initializer_list<std::span<const Key>> allowed);
/// Reads the keys that are there; looks materials up, defaults included.
void read_keys(const Value& table, std::string_view name, std::span<const Key> keys,
               std::span<const Material> materials, void* object);
/// The entries of `value` as a table; throws InputError if it is something else.
const Table& as_table(const Value& value, std::string_view name);
/// The elements of an array of tables under `key`; none if the key is absent.
std::vector<const Value*> tables(const Value& parent, std::string_view key);

/// Changes what `object` says to what the table says. Throws InputError naming place, key and what
/// is allowed.
template <class T>
void read(const Keys<T>& keys, const Value& table, std::span<const Material> materials, T& object) {
  check_known(table, keys.table, {keys.keys});
  read_keys(table, keys.table, keys.keys, materials, &object);
}

/// "; did you mean 'x'?", or nothing if no candidate is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
/// "a, b, c"
std::string join(std::span<const std::string_view> words, std::string_view separator = ", ");

/// The one of that name. Throws InputError if there is none: `complaint`, and which there are.
template <class T>
const T& find_named(std::span<const T> all, std::string_view name, const std::string& complaint,
                    const std::string& list = "; allowed: ", std::string_view separator = " | ") {
  std::vector<std::string_view> names;
  for (const T& one : all) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  throw InputError(complaint + did_you_mean(name, names) + list + join(names, separator));
}

/// The material of that name. Throws InputError, beginning with `where`, if there is none.
MaterialIndex find_material(std::string_view name, const std::string& where,
                            std::span<const Material> materials);

/// What a key allows, for errors and the reference: "a number from 0 to 1".
std::string allowed(const Key& key);
/// The name under which an angle may be given in degrees; empty if the key is no angle.
std::string degrees_name(const Key& key);
/// As short as it can be said: "0.1", "1e+06", "inf".
std::string format(double number);

}  // namespace sunder::scenes
