// Fills golden_report.html, which holds all there is of style and script.
#include "render/image/golden_report.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "engine/base/check.h"
#include "render/image/golden_page.h"

namespace sunder::render {
namespace {

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
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
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string figure(const char* kind, const char* caption, const Image& image) {
  if (image.rgb.empty()) return {};
  return std::string("<figure class=\"") + kind + "\"><img alt=\"\" src=\"data:image/png;base64," +
         base64(encode_png(image)) + "\"><figcaption>" + caption + "</figcaption></figure>\n";
}

std::string row(const char* what, const std::string& value, const std::string& limit, bool over) {
  return std::string("<tr><td>") + what + "<td" + (over ? " class=\"over\">" : ">") + value +
         "<td>" + limit + "</tr>\n";
}

std::string figures_table(const GoldenPicture& picture) {
  const Difference& d = picture.difference;
  const Thresholds& limits = picture.thresholds;
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5f", value);
    return std::string(text);
  };
  return "<table><tr><th>figure<th>measured<th>at most</tr>\n" +
         row("FLIP, mean", number(d.flip_mean), number(limits.flip_mean),
             d.flip_mean > limits.flip_mean) +
         row("pixels off in the worst 32x32 window",
             std::to_string(d.worst_window_pixels) + " at " + std::to_string(d.worst_window_x) +
                 ", " + std::to_string(d.worst_window_y),
             std::to_string(limits.window_pixels), d.worst_window_pixels > limits.window_pixels) +
         "</table>\n";
}

std::string mode_switch(std::size_t number) {
  std::string html = "<p>";
  for (const char* mode : {"side", "slider", "swap"}) {
    html += std::string("<label><input type=\"radio\" name=\"mode") + std::to_string(number) +
            "\" value=\"" + mode + "\"" + (html == "<p>" ? " checked" : "") + "> " + mode +
            "</label> ";
  }
  return html +
         "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.2\" hidden></p>\n";
}

std::string section(const GoldenPicture& picture, std::size_t number) {
  const bool comparable = !picture.reference.rgb.empty() && !picture.difference.same_bytes &&
                          picture.difference.same_size;
  std::string html = std::string("<section class=\"") + (picture.passed ? "pass" : "fail") +
                     "\">\n<h2>" + escaped(picture.name) + " <span>" +
                     (picture.passed ? "pass" : "FAIL") + "</span></h2>\n<p>" +
                     escaped(picture.verdict) + "</p>\n";
  if (comparable) html += figures_table(picture) + mode_switch(number);
  html += "<div class=\"views\">\n" + figure("reference", "reference", picture.reference);
  if (!picture.difference.same_bytes) html += figure("actual", "drawn now", picture.actual);
  html += figure("heat", "FLIP error", picture.difference.heat_map) + "</div>\n";
  if (!picture.passed) {
    html +=
        "<p>If what is drawn now is right: <code>" + escaped(picture.accept_by) + "</code></p>\n";
  }
  return html + "<p>Remade by <code>" + escaped(picture.remade_by) + "</code><br>Drawn by " +
         escaped(picture.renderer) + "</p>\n</section>\n";
}

}  // namespace

std::string golden_report(std::span<const GoldenPicture> pictures) {
  std::vector<const GoldenPicture*> order;
  for (const GoldenPicture& picture : pictures) order.push_back(&picture);
  std::stable_sort(order.begin(), order.end(), [](const GoldenPicture* a, const GoldenPicture* b) {
    return !a->passed && b->passed;
  });
  std::string sections;
  for (std::size_t i = 0; i < order.size(); ++i) sections += section(*order[i], i);

  std::string page = golden_page::golden_report_html;
  const std::string place = "<!-- pictures -->";
  const std::size_t at = page.find(place);
  SUNDER_CHECK(at != std::string::npos);
  return page.replace(at, place.size(), sections);
}

}  // namespace sunder::render
