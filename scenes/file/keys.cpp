// Reads tables by the declarations of their keys. Read first: read_keys(), then Reading.
#include "scenes/file/keys.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "engine/base/check.h"
#include "engine/geometry/approximate_hull.h"
#include "scenes/file/error_list.h"

namespace sunder::scenes {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kMinCorners = 3, kMaxCorners = 64;  // corners of an outline

std::string bounds(const Range& range) {
  const bool low = range.low > -std::numeric_limits<double>::max();
  const bool high = range.high < std::numeric_limits<double>::max();
  if (low && high) return " from " + format(range.low) + " to " + format(range.high);
  if (low) return " of at least " + format(range.low);
  return high ? " of at most " + format(range.high) : "";
}

/// One key of one table while its value is read.
struct Reading {
  const Value& value;
  const Key& key;
  std::string_view table;
  double scale;  ///< Factor from the number in the file to the stored one.

  /// Throws InputError for the value, or for the number `part` within it.
  [[noreturn]] void fail(const Value* part = nullptr) const {
    const std::string wrong = part ? ", in which " + describe(*part) + " is wrong" : "";
    throw InputError(value.where + ": " + std::string(key.name) + " in " + std::string(table) +
                     " is " + describe(value) + wrong + "; allowed: " + allowed(key));
  }

  double number(const Value& from) const {
    const Value* const part = &from == &value ? nullptr : &from;
    double number = 0;
    if (const auto* integer = std::get_if<std::int64_t>(&from.data)) {
      number = static_cast<double>(*integer);
    } else if (const auto* real = std::get_if<double>(&from.data)) {
      number = *real;
    } else {
      fail(part);
    }
    // The negated condition makes NaN fail too; infinity passes if the range includes it.
    if (!(number >= key.range.low && number <= key.range.high)) fail(part);
    return number * scale;
  }

  template <class T>
  const T& exactly() const {
    const T* exact = std::get_if<T>(&value.data);
    if (!exact) fail();
    return *exact;
  }

  /// Returns the length of an array; 0 for any other value.
  static std::size_t length(const Value& row) {
    const Array* array = std::get_if<Array>(&row.data);
    return array ? array->size() : 0;
  }

  std::size_t choice() const {
    const auto found = std::find(key.choices.begin(), key.choices.end(), exactly<std::string>());
    if (found == key.choices.end()) fail();
    return static_cast<std::size_t>(found - key.choices.begin());
  }

  void read(bool& to) const { to = exactly<bool>(); }
  void read(double& to) const { to = number(value); }
  void read(MaterialRef& to) const { to.name = exactly<std::string>(); }
  void read(std::string& to) const {
    if (exactly<std::string>().empty()) fail();
    to = exactly<std::string>();
  }
  void read(Fit& to) const {
    const std::optional<Fit> fit = parse_fit(exactly<std::string>());
    if (!fit) fail();
    to = *fit;
  }
  void read(CountOrFile& to) const {
    to = {};
    if (std::holds_alternative<std::string>(value.data)) {
      read(to.file);
    } else {
      read(to.count);
    }
  }
  void read(std::vector<Vec2>& to) const {
    const Array& corners = exactly<Array>();
    if (corners.size() < kMinCorners || corners.size() > kMaxCorners) fail();
    to.clear();
    for (const Value& corner : corners) {
      const Array* xy = std::get_if<Array>(&corner.data);
      if (!xy || xy->size() != 2) fail();
      to.emplace_back(number((*xy)[0]), number((*xy)[1]));
    }
  }
  void read(HeightGrid& to) const {
    to = {};
    const Array& rows = exactly<Array>();
    for (const Value& row : rows) {
      const Array* numbers = std::get_if<Array>(&row.data);
      if (!numbers || numbers->size() != length(rows[0])) fail();
      for (const Value& one : *numbers) to.values.push_back(number(one));
    }
    to.columns = rows.empty() ? 0 : length(rows[0]);
    if (rows.size() < 2 || to.columns < 2) fail();
  }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void read(Integer& to) const {
    if (!std::holds_alternative<std::int64_t>(value.data)) fail();
    to = static_cast<Integer>(number(value));
  }
  template <class Scalar>
  void read(Eigen::Matrix<Scalar, 3, 1>& to) const {
    const Array* array = std::get_if<Array>(&value.data);
    if (!array || array->size() != 3) fail();
    for (int i = 0; i < 3; ++i) {
      to[i] = static_cast<Scalar>(number((*array)[static_cast<std::size_t>(i)]));
    }
  }
};

void store(const Reading& reading, void* object) {
  if (reading.key.kind == Key::Kind::kChoice) reading.key.choose(object, reading.choice());
  use_field(reading.key, object, [&](auto& field) { reading.read(field); });
}

/// Returns the key of an angle in degrees, called `name`, with limits rounded to 0.01°.
Key in_degrees(const Key& key, std::string_view name) {
  const auto limit = [](double angle_rad) { return std::round(100 * angle_rad / kDegree) / 100; };
  Key degrees = key;
  degrees.name = name;
  degrees.unit = "degrees";
  degrees.range = {limit(key.range.low), limit(key.range.high)};
  return degrees;
}

/// Returns the Levenshtein distance of two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

MaterialIndex find_material(std::string_view name, const std::string& where,
                            std::span<const Material> materials) {
  return MaterialIndex(find_named(materials, name,
                                  where + ": unknown material '" + std::string(name) + "'",
                                  "; materials: ", ", "));
}

std::string degrees_name(const Key& key) {
  const std::string name(key.name);
  return name.ends_with("_rad") ? name.substr(0, name.size() - 3) + "deg" : std::string();
}

std::string format(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

std::string join(std::span<const std::string_view> words, std::string_view separator) {
  std::string joined;
  for (std::string_view word : words) {
    if (!joined.empty()) joined += separator;
    joined += word;
  }
  return joined;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  std::string_view nearest;
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < fewest) {
      fewest = distance;
      nearest = candidate;
    }
  }
  return nearest.empty() ? "" : "; did you mean '" + std::string(nearest) + "'?";
}

std::string allowed(const Key& key) {
  using Kind = Key::Kind;
  const std::string unit = key.unit.empty() ? "" : ", in " + std::string(key.unit);
  switch (key.kind) {
    case Kind::kBool:
      return "true or false";
    case Kind::kInteger:
    case Kind::kCount:
    case Kind::kSeed:
      return "a whole number" + bounds(key.range) + unit;
    case Kind::kNumber:
      return "a number" + bounds(key.range) + unit;
    case Kind::kVector:
    case Kind::kColor:
      return "[x, y, z], each a number" + bounds(key.range) + unit;
    case Kind::kOutline:
      return "[[x, y], ...], " + std::to_string(kMinCorners) + " to " +
             std::to_string(kMaxCorners) + " corners, each a number" + bounds(key.range) + unit;
    case Kind::kGrid:
      return "[[h, h, ...], ...], two rows or more of equal length, two or more, each a number" +
             bounds(key.range) + unit;
    case Kind::kText:
      return "a non-empty string";
    case Kind::kMaterial:
      return "the name of a material";
    case Kind::kCountOrFile:
      return "a whole number" + bounds(key.range) + ", or the path of a file that lists them";
    case Kind::kFit:
      return std::string(kFitNames);
    case Kind::kChoice:
      return join(key.choices, " | ");
    case Kind::kTable:
      return "a table";
  }
  return "";
}

void check_known(const Value& table, std::string_view name,
                 std::initializer_list<std::span<const Key>> allowed_keys) {
  std::vector<std::string_view> names;
  std::vector<std::string> degrees;
  for (std::span<const Key> keys : allowed_keys) {
    for (const Key& key : keys) {
      names.push_back(key.name);
      if (std::string angle = degrees_name(key); !angle.empty()) degrees.push_back(angle);
    }
  }
  std::vector<std::string_view> candidates = names;
  candidates.insert(candidates.end(), degrees.begin(), degrees.end());
  ErrorList errors;
  for (const Entry& entry : as_table(table, name)) {
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
    if (std::find(degrees.begin(), degrees.end(), entry.key) != degrees.end()) continue;
    errors.collect([&] {
      throw InputError(entry.value.where + ": unknown key '" + entry.key + "' in " +
                       std::string(name) + did_you_mean(entry.key, candidates) +
                       "; allowed: " + join(names));
    });
  }
  errors.throw_any();
}

/// Throws InputError for a missing key, at the place of an unknown key with a similar name, if any.
[[noreturn]] void refuse_missing(const Value& table, std::string_view name, const Key& key,
                                 std::span<const Key> keys) {
  constexpr std::size_t kShort = 2;  // names up to this length are similar to any other
  const std::string missing =
      ": missing key '" + std::string(key.name) + "' in " + std::string(name);
  for (const Entry& entry : as_table(table, name)) {
    const auto is_it = [&](const Key& known) { return known.name == entry.key; };
    if (entry.key.size() <= kShort || std::ranges::any_of(keys, is_it)) continue;
    if (did_you_mean(entry.key, std::span(&key.name, 1)).empty()) continue;
    throw InputError(entry.value.where + missing + "; did you misspell it as '" + entry.key +
                     "'? Allowed: " + allowed(key));
  }
  throw InputError(table.where + missing + ": " + allowed(key));
}

/// Reads one key of `keys`, if the table has it. Throws InputError.
void read_key(const Value& table, std::string_view name, const Key& key, std::span<const Key> keys,
              std::span<const Material> materials, void* object) {
  const Table& entries = as_table(table, name);
  const std::string degrees_key = degrees_name(key);
  const Value* value = find(entries, key.name);
  const Value* degrees = degrees_key.empty() ? nullptr : find(entries, degrees_key);
  if (value && degrees) {
    throw InputError(degrees->where + ": " + degrees_key + " and " + std::string(key.name) +
                     " in " + std::string(name) + " exclude each other; remove one");
  }
  if (!value && !degrees && key.required) refuse_missing(table, name, key, keys);
  if (value) store({*value, key, name, 1}, object);
  if (degrees) store({*degrees, in_degrees(key, degrees_key), name, kDegree}, object);
  if (key.kind == Key::Kind::kMaterial) {
    MaterialRef& material = *static_cast<MaterialRef*>(key.field(object));
    material.index = find_material(material.name, value ? value->where : table.where, materials);
  }
}

void read_keys(const Value& table, std::string_view name, std::span<const Key> keys,
               std::span<const Material> materials, void* object) {
  as_table(table, name);
  ErrorList errors;
  for (const Key& key : keys)
    errors.collect([&] { read_key(table, name, key, keys, materials, object); });
  errors.throw_any();
}

const Table& as_table(const Value& value, std::string_view name) {
  const Table* table = std::get_if<Table>(&value.data);
  if (!table) {
    throw InputError(value.where + ": " + std::string(name) + " is " + describe(value) +
                     "; expected a table");
  }
  return *table;
}

std::vector<const Value*> tables(const Value& parent, std::string_view key) {
  const Value* value = find(parent, key);
  if (!value) return {};
  const std::string name = "[[" + std::string(key) + "]]";
  const Array* array = std::get_if<Array>(&value->data);
  if (!array) {
    throw InputError(value->where + ": " + name + " is " + describe(*value) +
                     "; expected an array of tables: write " + name + " with two brackets");
  }
  std::vector<const Value*> all;
  for (const Value& element : *array) {
    as_table(element, name);
    all.push_back(&element);
  }
  return all;
}

}  // namespace sunder::scenes
