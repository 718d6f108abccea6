// Converts TOML to values, and changes values by assignments from the command line.
#include "scenes/file/value.h"

#include <algorithm>
#include <charconv>
#include <sstream>

// toml++ is header-only, and this is the only file that compiles it. Its parser reports errors of a
// text, but also asserts some of them, which is turned off here.
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

#include "engine/base/check.h"
#include "scenes/file/toml_depth.h"

namespace sunder::scenes {
namespace {

[[noreturn]] void refuse_depth(const std::string& where) {
  throw InputError(where + ": more than " + std::to_string(kMaxTomlDepth) +
                   " tables and arrays are nested in each other; scene files need no more");
}

class Converter {
 public:
  explicit Converter(const std::string& file) : file_(file) {}

  Value operator()(const toml::node& node) const {
    const std::string where = at(node.source());
    switch (node.type()) {
      case toml::node_type::boolean:
        return {where, node.as_boolean()->get()};
      case toml::node_type::integer:
        return {where, node.as_integer()->get()};
      case toml::node_type::floating_point:
        return {where, node.as_floating_point()->get()};
      case toml::node_type::string:
        return {where, node.as_string()->get()};
      case toml::node_type::array:
        return {where, array(*node.as_array())};
      case toml::node_type::table:
        return {where, table(*node.as_table())};
      default:
        throw InputError(where + ": dates and times are not allowed in scene files");
    }
  }

  std::string at(const toml::source_region& source) const {
    return file_ + ":" + std::to_string(source.begin.line);
  }

 private:
  Array array(const toml::array& from) const {
    Array to;
    for (const toml::node& node : from) to.push_back((*this)(node));
    return to;
  }

  Table table(const toml::table& from) const {
    Table to;
    for (const auto& [key, node] : from) to.push_back({std::string(key.str()), (*this)(node)});
    return to;
  }

  const std::string& file_;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

bool is_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/' || c == ' ';
  });
}

Value parse_flag_value(const std::string& text, const std::string& flag) {
  if (find_too_deep_line(text)) refuse_depth(flag);
  try {
    toml::table parsed = toml::parse("value = " + text);
    Value value = Converter(flag)(*parsed.get("value"));
    return value;
  } catch (const toml::parse_error&) {
    if (is_word(text)) return {flag, text};
    throw InputError(flag + ": '" + text +
                     "' is not a TOML value (a number, true, \"text\", [...])");
  }
}

/// Sets the place of a value and of all values in it.
void set_place(Value& value, const std::string& where) {
  value.where = where;
  if (Array* array = std::get_if<Array>(&value.data)) {
    for (Value& element : *array) set_place(element, where);
  } else if (Table* table = std::get_if<Table>(&value.data)) {
    for (Entry& entry : *table) set_place(entry.value, where);
  }
}

Value& element(Array& array, const std::string& index, const std::string& flag) {
  std::size_t i = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), i);
  if (error != std::errc() || end != index.data() + index.size() || i >= array.size()) {
    throw InputError(flag + ": '" + index + "' is not an index of an array of " +
                     std::to_string(array.size()) + " (the first is 0)");
  }
  return array[i];
}

Value& member(Table& table, const std::string& key, const std::string& flag) {
  for (Entry& entry : table) {
    if (entry.key == key) return entry.value;
  }
  table.push_back({key, {flag, Table{}}});
  return table.back().value;
}

}  // namespace

const Value* find(const Table& table, std::string_view key) {
  for (const Entry& entry : table) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

const Value* find(const Value& table, std::string_view key) {
  const Table* entries = std::get_if<Table>(&table.data);
  return entries ? find(*entries, key) : nullptr;
}

std::string describe(const Value& value) {
  struct Describe {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return "the number " + std::to_string(i); }
    std::string operator()(double d) const {
      std::ostringstream out;
      out << "the number " << d;
      return out.str();
    }
    std::string operator()(const std::string& s) const { return "the string \"" + s + "\""; }
    std::string operator()(const Array& a) const {
      constexpr std::size_t kMaxNumbersShown = 4;
      const auto is_number = [](const Value& item) {
        return std::holds_alternative<std::int64_t>(item.data) ||
               std::holds_alternative<double>(item.data);
      };
      if (a.empty() || a.size() > kMaxNumbersShown || !std::ranges::all_of(a, is_number))
        return "an array of " + std::to_string(a.size());
      std::ostringstream out;
      for (std::size_t i = 0; i < a.size(); ++i) {
        out << (i == 0 ? "[" : ", ");
        std::visit(
            [&](const auto& number) {
              if constexpr (std::is_arithmetic_v<std::decay_t<decltype(number)>>) out << number;
            },
            a[i].data);
      }
      return out.str() + "]";
    }
    std::string operator()(const Table&) const { return "a table"; }
  };
  return std::visit(Describe(), value.data);
}

Value parse_toml(const std::string& text, const std::string& file) {
  if (const auto line = find_too_deep_line(text)) refuse_depth(file + ":" + std::to_string(*line));
  try {
    const toml::table root = toml::parse(text, file);
    Value document = Converter(file)(root);
    document.where = file;
    return document;
  } catch (const toml::parse_error& error) {
    throw InputError(file + ":" + std::to_string(error.source().begin.line) + ": " +
                     std::string(error.description()));
  }
}

void set_value(Value& document, const std::string& assignment) {
  constexpr std::size_t kMostShown = 200;
  const std::string flag =
      "--set " +
      (assignment.size() <= kMostShown ? assignment : assignment.substr(0, kMostShown) + "...");
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size()) {
    throw InputError(flag + ": expected key=value, such as script.enabled=false");
  }
  const std::vector<std::string> steps = split(assignment.substr(0, equals), '.');
  if (steps.size() > kMaxTomlDepth) refuse_depth(flag);
  Value* place = &document;
  for (const std::string& step : steps) {
    if (Array* array = std::get_if<Array>(&place->data)) {
      place = &element(*array, step, flag);
    } else if (Table* table = std::get_if<Table>(&place->data)) {
      place = &member(*table, step, flag);
    } else {
      throw InputError(flag + ": there is no key '" + step + "' in " + describe(*place));
    }
  }
  *place = parse_flag_value(assignment.substr(equals + 1), flag);
  set_place(*place, flag);
}

}  // namespace sunder::scenes
