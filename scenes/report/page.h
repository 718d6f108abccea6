// HTML pages of reports, self-contained, for light and dark screens; plots for them are in plot.h.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace sunder::scenes {

/// Returns text with the special characters of HTML and SVG escaped.
std::string escaped(const std::string& text);

/// Returns a number with `digits` significant digits and no trailing zeros; infinity is "∞".
std::string rounded(double value, int digits = 3);

/// Writes bytes in base 64, padded.
void write_base64(std::span<const std::uint8_t> bytes, std::ostream& out);

/// Returns an image tag that contains a file of the given type ("image/png").
std::string embedded_image(const std::string& type, std::span<const std::uint8_t> bytes);

/// A table cell, not escaped yet.
struct Cell {
  std::string text;
  bool over = false;      ///< True: marked as exceeding a limit.
  std::string note = {};  ///< Tooltip.
};

/// Returns a table with a row of headings; missing cells at the end of a row are empty.
std::string html_table(const std::vector<std::string>& head,
                       std::span<const std::vector<Cell>> rows);

/// Content of a page. All but the title is inserted unescaped: HTML, CSS and script.
struct Page {
  std::string title;
  std::string body;
  std::string style = {};   ///< CSS in addition to the common style.
  std::string script = {};  ///< Runs after the body is loaded.
};
std::string html_page(const Page& page);

}  // namespace sunder::scenes
