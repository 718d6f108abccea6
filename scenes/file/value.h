// A TOML document as plain values, each with its file and line. Only value.cpp uses toml++.
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
using Table = std::vector<Entry>;  ///< Sorted by key after parsing.

/// One value and its place: "FILE:LINE", or the flag that set it.
struct Value {
  std::string where;
  std::variant<bool, std::int64_t, double, std::string, Array, Table> data;
};

struct Entry {
  std::string key;
  Value value;
};

/// Returns the value of a key; null if the table does not have the key, or the value is no table.
const Value* find(const Table& table, std::string_view key);
const Value* find(const Value& table, std::string_view key);
/// Returns "the string \"x\"", "the number 3", "an array of 2" and so on, for error messages.
std::string describe(const Value& value);

/// Parses a document. Throws InputError "FILE:LINE: ERROR" for wrong syntax.
Value parse_toml(const std::string& text, const std::string& file);

/// Sets one value of a document by "KEY=VALUE": a dotted key, in which a number is an index into an
/// array (ball.0.radius_m=2), and a TOML value, whose quotes may be left out. Adds the key if it is
/// missing, and does not check that it is known. Throws InputError.
void set_value(Value& document, const std::string& assignment);

}  // namespace sunder::scenes
