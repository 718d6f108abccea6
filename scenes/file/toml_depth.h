// The depth of a TOML text, found before it is parsed: parsers and destructors of deep documents
// call themselves once per level.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace sunder::scenes {

/// Most levels of tables and arrays within each other; scene files need five.
inline constexpr int kMaxTomlDepth = 32;

/// Returns the line, from 1, at which tables and arrays come to be within each other deeper than
/// kMaxTomlDepth; none if they do not. Dots of keys and of table names count as levels; those of
/// the name of a table do not add to those of the keys below it.
std::optional<std::size_t> find_too_deep_line(std::string_view text);

}  // namespace sunder::scenes
