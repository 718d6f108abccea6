// A TOML document as plain values that remember where they were written. Only value.cpp knows
// toml++.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sunder::scenes {

struct Value;
struct Entry;
using Array = std::vector<Value>;
using Table = std::vector<Entry>;  ///< In the order of their keys.

/// One value and its place: "FILE:LINE", or the flag that set it.
struct Value {
  std::string where;
  std::variant<bool, std::int64_t, double, std::string, Array, Table> data;
};

struct Entry {
  std::string key;
  Value value;
};

/// The value of a key; null if the table has none.
const Value* find(const Table& table, std::string_view key);
const Value* find(const Value& table, std::string_view key);
/// "the string \"x\"", "the number 3", "an array of 2": for error messages.
std::string describe(const Value& value);

/// Reads a document. Throws InputError "FILE:LINE: what is wrong" for bad syntax.
Value parse_toml(const std::string& text, const std::string& file);

/// Changes one value of a document by "key=value": a dotted key, where a number picks an element of
/// an array (ball.0.radius_m=2); a value in TOML, whose quotes may be left out. Whether the key
/// means anything is left to whoever reads the document.
void set_value(Value& document, const std::string& assignment);

}  // namespace sunder::scenes
