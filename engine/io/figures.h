// Flattened JSON documents, for files that the program reads back.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace sunder {

/// An empty list, which has no element whose path could represent it.
struct EmptyList {};

/// A JSON document by path: "/frame/p50_ms", "/scenes/0/name" (JSON pointers, RFC 6901).
using Figures =
    std::map<std::string, std::variant<bool, std::int64_t, double, std::string, EmptyList>>;

/// Parses JSON; throws InputError naming `file` on failure. Nulls and empty lists are omitted.
Figures parse_figures(const std::string& text, const std::string& file);
/// Returns the number at a path, integer or not; 0 if there is none.
double number_at(const Figures& figures, const std::string& place);
/// Returns the text at a path; empty if there is none.
std::string text_at(const Figures& figures, const std::string& place);
/// Returns the nested document, indented, with a final newline.
std::string format_figures(const Figures& figures);
/// Returns a JSON document of this program with `figures` added to it.
std::string add_figures(const std::string& document, const Figures& figures);

}  // namespace sunder
