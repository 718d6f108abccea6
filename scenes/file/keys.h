// Declarations of the keys of a scene file's tables. The reader, its errors and the reference in
// README.md all follow from one declaration for each key.
//
// Read first: scene_keys() in schema.cpp for an example, then read() below.
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
#include "engine/model/checks/ranges.h"
#include "engine/model/material.h"
#include "scenes/file/error_list.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// A material by name; read_keys() finds the index.
struct MaterialRef {
  std::string name;
  MaterialIndex index;
};

/// A number of items, or a file that lists the items.
struct CountOrFile {
  std::uint32_t count = 0;  ///< 0: the default number.
  std::string file;
};

/// Numbers in rows of equal length.
struct HeightGrid {
  std::size_t columns = 0;
  std::vector<double> values;  ///< Row by row.

  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// One key: its name, its allowed values and the field it is stored in.
struct Key {
  enum class Kind {  // up to kGrid in the order of detail::FieldTypes
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
    kTable,    ///< allowed here; read and documented elsewhere
  };

  std::string_view name;  ///< A name ending in _rad has a twin in degrees that ends in _deg.
  Kind kind = Kind::kTable;
  std::string_view unit;
  Range range;
  std::string_view help;
  bool required = false;
  bool optional = false;  ///< True if the field is a std::optional, without a default.
  std::span<const std::string_view> choices;
  void* (*field)(void* object) = nullptr;  ///< Returns the field; emplaces an optional one.
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

/// Types of the fields that keys are stored in, in the order of Key::Kind.
template <class... T>
struct TypeList {};
using FieldTypes =
    TypeList<bool, int, std::uint32_t, std::uint64_t, double, Vec3, Vec3f, std::string, MaterialRef,
             Fit, CountOrFile, std::vector<Vec2>, HeightGrid>;

template <class Field, class... T>
constexpr Key::Kind kind_of(TypeList<T...>) {
  int kind = 0;
  static_assert((std::is_same_v<Field, T> || ...) || std::is_enum_v<Field>);
  static_cast<void>(((std::is_same_v<Field, T> || (++kind, false)) || ...));
  return static_cast<Key::Kind>(kind);  // kChoice if Field is none of them
}

template <class Use, class... T>
void use_field(Key::Kind kind, void* field, const Use& use, TypeList<T...>) {
  int i = 0;
  ((i++ == static_cast<int>(kind) ? use(*static_cast<T*>(field)) : void()), ...);
}

}  // namespace detail

/// Returns a key that is stored in a member, whose initial value is the default.
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

/// Returns a key that names a value of an enumeration; `choices` are in the enumeration's order.
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

/// Calls `use` with the field of a key in `object`; does nothing for choices and tables.
template <class Use>
void use_field(const Key& key, void* object, const Use& use) {
  if (key.kind >= Key::Kind::kChoice) return;
  detail::use_field(key.kind, key.field(object), use, detail::FieldTypes());
}

/// Returns a key whose value is a table, or an array of tables, with keys of its own.
inline Key table_key(std::string_view name, std::string_view help) {
  Key key;
  key.name = name;
  key.help = help;
  return key;
}

/// The keys of one table, which are stored in a T.
template <class T>
struct Keys {
  std::string_view table;  ///< Name of the table, such as "[ground]".
  std::vector<Key> keys;
};

/// Throws InputErrors for keys of the table that are in none of `allowed`, naming the most similar.
void check_known(const Value& table, std::string_view name,
                 std::initializer_list<std::span<const Key>> allowed);
/// Reads the keys that the table has into `object`, and finds the indices of its materials, also of
/// defaults. Throws InputErrors that names each wrong key.
void read_keys(const Value& table, std::string_view name, std::span<const Key> keys,
               std::span<const Material> materials, void* object);
/// Returns the entries of `value`. Throws InputError if it is not a table.
const Table& as_table(const Value& value, std::string_view name);
/// Returns the elements of the array of tables under `key`; none if absent. Throws InputError.
std::vector<const Value*> tables(const Value& parent, std::string_view key);

/// Reads the keys that the table has into `object`. Throws InputErrors that names file, line, key
/// and the allowed values of each unknown or wrong key.
template <class T>
void read(const Keys<T>& keys, const Value& table, std::span<const Material> materials, T& object) {
  ErrorList errors;
  errors.collect([&] { check_known(table, keys.table, {keys.keys}); });
  errors.collect([&] { read_keys(table, keys.table, keys.keys, materials, &object); });
  errors.throw_any();
}

/// Returns "; did you mean 'x'?", or nothing if no candidate is similar to the word.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
/// Returns the words as "a, b, c".
std::string join(std::span<const std::string_view> words, std::string_view separator = ", ");

/// Returns the index of the element of this name, or throws InputError: `complaint` and a list of
/// all names.
template <class T>
std::size_t find_named(std::span<const T> all, std::string_view name, const std::string& complaint,
                       const std::string& list = "; allowed: ",
                       std::string_view separator = " | ") {
  std::vector<std::string_view> names;
  for (const T& one : all) {
    if (one.name == name) return names.size();
    names.push_back(one.name);
  }
  throw InputError(complaint + did_you_mean(name, names) + list + join(names, separator));
}

/// Returns the material of this name. Throws InputError that begins with `where` if there is none.
MaterialIndex find_material(std::string_view name, const std::string& where,
                            std::span<const Material> materials);

/// Returns the allowed values of a key, for errors and the reference: "a number from 0 to 1".
std::string allowed(const Key& key);
/// Returns the name under which an angle may be given in degrees; empty if the key is no angle.
std::string degrees_name(const Key& key);
/// Returns a number with six significant digits: "0.1", "1e+06", "inf".
std::string format(double number);

}  // namespace sunder::scenes
