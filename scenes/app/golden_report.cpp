#include "scenes/app/golden_report.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace sunder::app {
namespace {

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t j = 0; j < 3; ++j) word = word << 8 | (j < count ? bytes[i + j] : 0u);
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[word >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "&lt;";
    } else if (c == '&') {
      safe += "&amp;";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string figure(const char* caption, const render::Image& image) {
  std::string html = "<figure><figcaption>" + std::string(caption) + "</figcaption>";
  html += image.rgb.empty()
              ? std::string("none")
              : "<img src=\"data:image/png;base64," + base64(render::encode_png(image)) + "\">";
  return html + "</figure>";
}

}  // namespace

std::string golden_page(const std::vector<GoldenResult>& results) {
  std::string html =
      "<!doctype html><meta charset=\"utf-8\"><title>Sunder: golden images</title>\n"
      "<style>body{font:15px sans-serif;margin:2em}section{margin-bottom:2em}"
      "div{display:flex;gap:1em;flex-wrap:wrap}figure{margin:0}img{max-width:30vw}"
      ".fail h2{color:#b00020}</style>\n<h1>Golden images</h1>\n";
  for (const GoldenResult& result : results) {
    html += std::string("<section class=\"") + (result.passed ? "pass" : "fail") + "\"><h2>" +
            escaped(result.golden.name) + (result.passed ? ": pass" : ": FAIL") + "</h2><p>" +
            escaped(result.verdict) + "</p><div>" + figure("baseline", result.baseline) +
            figure("drawn now", result.actual) + figure("error", result.difference.heat_map) +
            "</div><p>Remade by <code>" + escaped(result.golden.command) + "</code><br>drawn by " +
            escaped(result.renderer) + "</p></section>\n";
  }
  return html;
}

}  // namespace sunder::app
