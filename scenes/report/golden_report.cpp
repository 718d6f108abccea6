// Generates the HTML; golden_report.css and golden_report.js hold the style and the script.
#include "scenes/report/golden_report.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <utility>
#include <vector>

#include "scenes/report/golden_page.h"

namespace sunder::scenes {
namespace {

std::string figure(const char* kind, const char* caption, const render::Image& image) {
  if (image.rgb.empty()) return {};
  return std::string("<figure class=\"") + kind + "\">" +
         embedded_image("image/png", render::encode_png(image)) + "<figcaption>" + caption +
         "</figcaption></figure>\n";
}

std::string figures_table(const GoldenResult& picture) {
  const render::Difference& d = picture.difference;
  const render::Thresholds& limits = picture.thresholds;
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5f", value);
    return std::string(text);
  };
  const std::vector<Cell> rows[] = {
      {{"FLIP, mean"},
       {number(d.flip_mean), d.flip_mean > limits.flip_mean},
       {number(limits.flip_mean)}},
      {{"pixels off in the worst 32x32 window"},
       {std::to_string(d.worst_window_pixels) + " at " + std::to_string(d.worst_window_x) + ", " +
            std::to_string(d.worst_window_y),
        d.worst_window_pixels > limits.window_pixels},
       {std::to_string(limits.window_pixels)}}};
  return html_table({"figure", "measured", "at most"}, rows);
}

/// Returns a table of the images that differ from their originals, the farthest first.
std::string originals_table(std::span<const GoldenResult> pictures) {
  std::vector<std::pair<double, const GoldenResult*>> order;
  for (const GoldenResult& picture : pictures) {
    if (!picture.from_original.same_size) continue;
    const double share = picture.from_original.share_of(picture.thresholds);
    if (share > 0) order.emplace_back(share, &picture);
  }
  if (order.empty()) return "<p>Every picture is equal to its original.</p>\n";
  std::ranges::stable_sort(order, std::greater(), &std::pair<double, const GoldenResult*>::first);
  std::vector<std::vector<Cell>> rows;
  for (const auto& [share, picture] : order) {
    const render::Difference& d = picture->from_original;
    rows.push_back({{picture->name},
                    {rounded(100 * share, 2), share > 1},
                    {rounded(d.flip_mean, 2)},
                    {std::to_string(d.worst_window_pixels)},
                    {picture->original.rgb.empty() ? "no" : "yes"}});
  }
  return "<h2>Distance from the originals</h2>\n<p>The original is the picture that was accepted "
         "first, or last with a reason (<code>golden accept --rebase</code>). A picture of more "
         "than 100 % is not accepted without one.</p>\n" +
         html_table({"picture", "% of what is allowed", "FLIP, mean", "pixels of a window",
                     "accepted since"},
                    rows);
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

std::string section(const GoldenResult& picture, std::size_t number) {
  const bool comparable = !picture.reference.rgb.empty() && !picture.difference.same_bytes &&
                          picture.difference.same_size;
  std::string html = std::string("<section class=\"") + (picture.passed ? "pass" : "fail") +
                     "\">\n<h2>" + escaped(picture.name) + " <span>" +
                     (picture.passed ? "pass" : "FAIL") + "</span></h2>\n<p>" +
                     escaped(picture.verdict) + "</p>\n";
  if (comparable) html += figures_table(picture) + mode_switch(number);
  html += "<div class=\"views\">\n" + figure("reference", "reference", picture.reference);
  if (!picture.difference.same_bytes) html += figure("actual", "drawn now", picture.actual);
  html += figure("heat", "FLIP error", picture.difference.heat_map);
  html += figure("original", "original", picture.original) + "</div>\n";
  if (!picture.rebased.empty())
    html += "<p>Reason of the last original: " + escaped(picture.rebased) + "</p>\n";
  if (!picture.runs.empty()) html += html_table({"simulated", "frames"}, picture.runs);
  if (!picture.passed) {
    html += "<p>To accept this picture: <code>" + escaped(picture.accept_command) + "</code></p>\n";
  }
  return html + "<p>Repeat by: <code>" + escaped(picture.remake_command) + "</code><br>Drawn by " +
         escaped(picture.renderer) + "</p>\n</section>\n";
}

}  // namespace

std::string golden_report(std::span<const GoldenResult> pictures) {
  std::vector<const GoldenResult*> order;
  for (const GoldenResult& picture : pictures) order.push_back(&picture);
  std::stable_sort(order.begin(), order.end(), [](const GoldenResult* a, const GoldenResult* b) {
    return !a->passed && b->passed;
  });
  std::string sections;
  for (std::size_t i = 0; i < order.size(); ++i) sections += section(*order[i], i);

  return html_page({"Sunder: goldens",
                    "<h1>Goldens</h1>\n<p>Point at a picture for the magnifier. Heat: black "
                    "no error, red, yellow, white the most.</p>\n" +
                        originals_table(pictures) + sections + "<div id=\"lens\"></div>\n",
                    golden_page::golden_report_css, golden_page::golden_report_js});
}

}  // namespace sunder::scenes
