#include "scenes/report/page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <sstream>
#include <utility>

namespace sunder::scenes {
namespace {

// The browser's colours are kept; the added ones are visible on light and dark backgrounds.
constexpr const char* kPageStyle = R"(
  :root { color-scheme: light dark; }
  body { font: 15px/1.4 sans-serif; margin: 2em; }
  h2 { margin: 0; font-size: 1.2em; }
  section { padding: 1em 1.4em; margin-bottom: 1.5em; border-left: 6px solid #8888; background: #8881; }
  table { border-collapse: collapse; margin: .6em 0; }
  td, th { padding: .15em 1.2em .15em 0; text-align: left; font-variant-numeric: tabular-nums; }
  tr + tr > td { border-top: 1px solid #8884; }
  .over { color: #d03040; font-weight: bold; }
  code { background: #8883; padding: .1em .4em; user-select: all; }
  svg { max-width: 100%; height: auto; }
)";

}  // namespace

void write_base64(std::span<const std::uint8_t> bytes, std::ostream& out) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t j = 0; j < 3; ++j) word = word << 8 | (j < count ? bytes[i + j] : 0u);
    char digits[4] = {};
    for (std::size_t j = 0; j < 4; ++j) {
      digits[j] = j <= count ? kDigits[word >> (18 - 6 * j) & 63] : '=';
    }
    out.write(digits, sizeof digits);
  }
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string rounded(double value, int digits) {
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string embedded_image(const std::string& type, std::span<const std::uint8_t> bytes) {
  std::ostringstream tag;
  tag << "<img alt=\"\" src=\"data:" << type << ";base64,";
  write_base64(bytes, tag);
  tag << "\">";
  return std::move(tag).str();
}

std::string html_table(const std::vector<std::string>& head,
                       std::span<const std::vector<Cell>> rows) {
  std::string html = "<table>\n<tr>";
  for (const std::string& heading : head) html += "<th>" + escaped(heading) + "</th>";
  html += "</tr>\n";
  for (const std::vector<Cell>& row : rows) {
    html += "<tr>";
    for (const Cell& cell : row) {
      html += std::string("<td") + (cell.over ? " class=\"over\"" : "") +
              (cell.note.empty() ? "" : " title=\"" + escaped(cell.note) + "\"") + ">" +
              escaped(cell.text) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string html_page(const Page& page) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
      escaped(page.title) + "</title>\n<style>" + kPageStyle + page.style +
      "</style>\n</head>\n<body>\n" + page.body;
  if (!page.script.empty()) html += "<script>\n" + page.script + "</script>\n";
  return html + "</body>\n</html>\n";
}

}  // namespace sunder::scenes
