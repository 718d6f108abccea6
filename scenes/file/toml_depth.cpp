#include "scenes/file/toml_depth.h"

#include <algorithm>
#include <vector>

namespace sunder::scenes {
namespace {

/// Returns the end of the string that begins at `at` with a quotation mark; the end of the line, or
/// of the text, if it is not closed.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool has_escapes = quote == '"';
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
  const bool has_lines = text.substr(at).starts_with(three);
  for (at += has_lines ? 3 : 1; at < text.size(); ++at) {
    if (has_escapes && text[at] == '\\') {
      ++at;
    } else if (!has_lines && (text[at] == quote || text[at] == '\n')) {
      return text[at] == quote ? at + 1 : at;
    } else if (has_lines && text.substr(at).starts_with(three)) {
      at += 3;
      for (int more = 0; more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
      return at;  // up to two quotation marks more belong to the text
    }
  }
  return text.size();
}

}  // namespace

std::optional<std::size_t> find_too_deep_line(std::string_view text) {
  std::vector<int> outer;  // depth at which each open bracket stands
  int depth = 0;           // brackets, and dots of the keys on the way here
  std::size_t line = 1;
  const auto base = [&] { return outer.empty() ? 0 : outer.back() + 1; };
  for (std::size_t at = 0; at < text.size(); ++at) {
    switch (text[at]) {
      case '#':
        at = std::min(text.find('\n', at), text.size()) - 1;
        break;
      case '"':
      case '\'': {
        const std::size_t end = end_of_string(text, at);
        line += static_cast<std::size_t>(std::ranges::count(text.substr(at, end - at), '\n'));
        at = end - 1;
        break;
      }
      case '[':
      case '{':
        outer.push_back(depth++);
        break;
      case ']':
      case '}':
        if (!outer.empty()) {
          depth = outer.back();
          outer.pop_back();
        }
        break;
      case '.':
        ++depth;
        break;
      case ',':
        depth = base();
        break;
      case '\n':
        depth = base();
        ++line;
        break;
      default:
        break;
    }
    if (depth > kMaxTomlDepth) return line;
  }
  return std::nullopt;
}

}  // namespace sunder::scenes
