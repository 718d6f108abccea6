// A check that HTML or SVG is well-formed: tags closed, attributes quoted, each & an entity.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace sunder::tests {

/// Returns the first mistake in an HTML page or an SVG picture, or an empty string. The contents of
/// <style> and <script> are not checked.
inline std::string markup_mistake(const std::string& text) {
  static const std::set<std::string> kWithoutEnd = {"!doctype", "meta", "img", "br", "input"};
  std::vector<std::string> open;
  std::size_t at = 0;
  while (at < text.size()) {
    if (text[at] == '&') {
      const std::size_t end = text.find(';', at);
      if (end == std::string::npos || end - at > 6) return "a bare & at " + text.substr(at, 20);
    }
    if (text[at] != '<') {
      ++at;
      continue;
    }
    const std::size_t start = at + 1;
    bool quoted = false;
    for (++at; at < text.size() && (quoted || text[at] != '>'); ++at) {
      if (text[at] == '"') quoted = !quoted;
      if (text[at] == '<') return "a bare < in <" + text.substr(start, 20);
    }
    if (at == text.size()) return "no end of <" + text.substr(start, 20);
    const std::string tag = text.substr(start, at++ - start);
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (name.front() == '/') {
      if (open.empty() || open.back() != name.substr(1)) return "<" + tag + "> ends nothing";
      open.pop_back();
    } else if (tag.back() != '/' && !kWithoutEnd.contains(name)) {
      open.push_back(name);
      if (name == "style" || name == "script") at = text.find("</" + name, at);
    }
  }
  return open.empty() ? "" : "no end of <" + open.back() + ">";
}

}  // namespace sunder::tests
