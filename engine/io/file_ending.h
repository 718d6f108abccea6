// Endings of file names.
#pragma once

#include <algorithm>
#include <cctype>
#include <string_view>

namespace sunder {

/// Returns true if the name of a file ends with `ending` (in lower case, as ".png"), in any letter
/// case.
inline bool has_ending(std::string_view file, std::string_view ending) {
  const auto is_same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  };
  return file.size() >= ending.size() &&
         std::ranges::equal(file.substr(file.size() - ending.size()), ending, is_same);
}

}  // namespace sunder
