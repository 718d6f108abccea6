// JSON as figures: a flat list of what is where, for files the program reads back.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace sunder {

/// A list without elements, which has no place to be seen at otherwise.
struct EmptyList {};

/// A JSON document by place: "/frame/p50_ms", "/scenes/0/name" (JSON pointers, RFC 6901).
using Figures =
    std::map<std::string, std::variant<bool, std::int64_t, double, std::string, EmptyList>>;

/// Throws InputError naming `file` if the text is not JSON. Nulls and empty lists are left out.
Figures parse_figures(const std::string& text, const std::string& file);
/// The number at a place, whole or not; 0 if none is there.
double number_at(const Figures& figures, const std::string& place);
/// The text at a place; empty if none is there.
std::string text_at(const Figures& figures, const std::string& place);
/// The nested document, indented; ends with a newline.
std::string format_figures(const Figures& figures);

}  // namespace sunder
