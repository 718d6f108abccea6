// Pages of a report: HTML that needs nothing beside it, and reads as well on a dark screen. Data
// in, text out; plots to go on them are in plot.h.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunder {

/// Text as it may stand between tags and in quoted attributes, of HTML and of SVG.
std::string escaped(const std::string& text);

/// A number with so many significant digits, without zeros at the end; ∞ is a sign.
std::string rounded(double value, int digits = 3);

/// An image tag with a file of that type ("image/png") inside it.
std::string embedded_image(const std::string& type, std::span<const std::uint8_t> bytes);

/// Text in a table, not escaped yet.
struct Cell {
  std::string text;
  bool over = false;      ///< Marked: it is beyond what it should be.
  std::string note = {};  ///< Shown to who points at it.
};

/// A table with a row of headings; a first cell that ends a row early leaves the rest empty.
std::string html_table(const std::vector<std::string>& head,
                       std::span<const std::vector<Cell>> rows);

/// What a page is made of; all but the title is HTML, or CSS and script, as it is to stand there.
struct Page {
  std::string title;
  std::string body;
  std::string style = {};   ///< Beside that of all pages.
  std::string script = {};  ///< Run once the body is there.
};
std::string html_page(const Page& page);

}  // namespace sunder
