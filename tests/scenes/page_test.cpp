// Tests of HTML pages and SVG plots: well-formed for any content, and complete.
#include "scenes/report/page.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "scenes/report/plot.h"
#include "tests/engine/markup.h"

namespace sunder::scenes {
namespace {

using tests::markup_mistake;

const std::string kMarkupText = "a<b> & \"c\" 'd' </svg>";

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Markup, TheCheckFindsMistakes) {
  for (const char* wrong :
       {"<p>", "<p><b></p></b>", "a & b", "<p title=\"<\"></p>", "</p>", "<p"}) {
    EXPECT_NE(markup_mistake(wrong), "") << wrong;
  }
  EXPECT_EQ(markup_mistake("<!doctype html><p title=\">\">1 &lt; 2<br></p><svg/>"), "");
}

TEST(Page, TextIsEscaped) {
  EXPECT_EQ(escaped("a<b & \"c\" 'd'"), "a&lt;b &amp; &quot;c&quot; &#39;d&#39;");
  const std::vector<Cell> rows[] = {{{kMarkupText, true, kMarkupText}, {"plain"}}};
  const std::string page = html_page({kMarkupText, html_table({kMarkupText}, rows)});
  EXPECT_EQ(markup_mistake(page), "");
  EXPECT_EQ(count(page, "</svg>"), 0u);
  EXPECT_EQ(count(page, "<td>plain</td>"), 1u);
  EXPECT_EQ(count(page, "class=\"over\""), 1u);
}

TEST(Page, StyleAndScriptAreNotEscaped) {
  const std::string page =
      html_page({"t", "<p>body</p>\n", "p { color: red; }", "if (1 < 2) f();\n"});
  EXPECT_EQ(markup_mistake(page), "");
  EXPECT_NE(page.find("p { color: red; }"), std::string::npos);
  EXPECT_NE(page.find("if (1 < 2) f();"), std::string::npos);
  EXPECT_LT(page.find("<p>body</p>"), page.find("<script>"));
  EXPECT_EQ(count(html_page({"t", ""}), "<script>"), 0u);
}

TEST(Page, ImagesAreEmbeddedAsBase64) {
  const std::uint8_t bytes[] = {'M', 'a', 'n', 'y', 0xff};
  EXPECT_NE(embedded_image("image/png", bytes).find("\"data:image/png;base64,TWFuef8=\""),
            std::string::npos);
  EXPECT_NE(embedded_image("image/png", std::span(bytes).first(4)).find(",TWFueQ==\""),
            std::string::npos);
}

TEST(Page, NumbersAreRounded) {
  EXPECT_EQ(rounded(1234.5), "1.23e+03");
  EXPECT_EQ(rounded(0.5), "0.5");
  EXPECT_EQ(rounded(1.23456, 5), "1.2346");
  EXPECT_EQ(rounded(std::numeric_limits<double>::infinity()), "∞");
}

const Axes kLogLog = {"title", {"cost", true}, {"error", true}};

/// Returns the centres of the plot's circles, in order.
std::vector<std::pair<double, double>> dots(const std::string& svg) {
  std::vector<std::pair<double, double>> places;
  const std::string start = "<circle cx=\"";
  for (std::size_t at = svg.find(start); at != std::string::npos; at = svg.find(start, at + 1)) {
    double x = 0, y = 0;
    EXPECT_EQ(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\"", &x, &y), 2);
    places.emplace_back(x, y);
  }
  return places;
}

TEST(Plot, IsWellFormedWhateverItIsGiven) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Curve curves[] = {
      {kMarkupText, {{1, 2, kMarkupText, kMarkupText}, {0, -1}, {infinity, nan}}, true, true},
      {"empty", {}}};
  const Bar bars[] = {{kMarkupText, 3}, {"zero", 0}, {"infinite", infinity}};
  for (const std::string& svg :
       {svg_curves(kLogLog, curves),
        svg_curves({kMarkupText, {kMarkupText}, {kMarkupText}}, curves), svg_curves(kLogLog, {}),
        svg_bars({"t", {"x"}, {"y"}}, bars), svg_bars({}, {})}) {
    EXPECT_EQ(markup_mistake(svg), "") << svg;
    EXPECT_EQ(count(svg, "nan"), 0u) << svg;
    EXPECT_EQ(count(svg, "\"inf"), 0u) << svg;
  }
}

TEST(Plot, EqualRatiosAreEquallyFarOnLogarithmicAxes) {
  const Curve curves[] = {{"", {{1, 100}, {10, 10}, {100, 1}}, false, true}};
  const auto places = dots(svg_curves(kLogLog, curves));
  ASSERT_EQ(places.size(), 3u);
  EXPECT_NEAR(places[1].first - places[0].first, places[2].first - places[1].first, 0.02);
  EXPECT_GT(places[1].first, places[0].first);
  EXPECT_GT(places[1].second, places[0].second) << "smaller values are lower";
}

TEST(Plot, ValuesOutsideALogarithmicAxisAreDrawnAtItsEnds) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Curve curves[] = {{"", {{1, 1}, {10, 10}, {5, infinity}, {5, 0}}, false, true}};
  const auto places = dots(svg_curves(kLogLog, curves));
  ASSERT_EQ(places.size(), 4u);
  EXPECT_LT(places[2].second, places[1].second) << "above the largest";
  EXPECT_GT(places[3].second, places[0].second) << "below the smallest";
}

TEST(Plot, NamesOfNeighboursDoNotCoverEachOther) {
  const Curve curves[] = {{"", {{1, 1}, {10, 10, "first"}, {10, 10.01, "second"}, {99, 99}}}};
  const std::string svg = svg_curves(kLogLog, curves);
  const auto height = [&](const std::string& name) {
    const std::size_t start = svg.rfind(" y=\"", svg.find(">" + name + "<"));
    return std::stod(svg.substr(start + 4));
  };
  EXPECT_GT(std::abs(height("first") - height("second")), 10);
}

TEST(Plot, TheLegendIsAboveEveryPoint) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Curve curves[] = {{"one", {{1, 1}, {99, 99}, {99, infinity}, {1, infinity}}, true, true},
                          {"another", {{99, 98}}, true, true}};
  const std::string svg = svg_curves(kLogLog, curves);
  std::vector<double> bottoms;
  for (std::size_t at = svg.find("<rect"); at != std::string::npos; at = svg.find("<rect", at + 1))
    bottoms.push_back(std::stod(svg.substr(svg.find(" y=\"", at) + 4)) + 10);
  EXPECT_EQ(bottoms.size(), 2u);
  for (const auto& [x, y] : dots(svg)) {
    for (const double bottom : bottoms) EXPECT_GT(y - 4.5, bottom);
  }
}

TEST(Plot, TicksOnANarrowLogarithmicAxisAreEnough) {
  const Curve curves[] = {{"", {{2.1, 1}, {3.9, 1000}}}};
  const std::string svg = svg_curves(kLogLog, curves);
  for (const char* tick : {">2.5<", ">3<", ">3.5<", ">1<", ">10<", ">100<", ">1000<"}) {
    EXPECT_EQ(count(svg, tick), 1u) << tick;
  }
}

TEST(Plot, TicksAreRoundAndWithinTheAxis) {
  const Curve curves[] = {{"", {{0, 0}, {600, 0.3}}}};
  const std::string svg = svg_curves({"", {"frame"}, {"ms"}}, curves);
  for (const char* tick : {">0<", ">200<", ">400<", ">600<", ">0.1<", ">0.2<", ">0.3<"}) {
    EXPECT_EQ(count(svg, tick) >= 1, true) << tick;
  }
  EXPECT_EQ(count(svg, ">800<"), 0u);
}

TEST(Plot, BarsAreAsHighAsTheirValues) {
  const Bar bars[] = {{"one", 1}, {"two", 2}, {"none", 0}};
  const std::string svg = svg_bars({"", {"size"}, {"count"}}, bars);
  std::vector<double> heights;
  const std::string start = " height=\"";
  for (std::size_t at = svg.find("<rect"); at != std::string::npos;
       at = svg.find("<rect", at + 1)) {
    heights.push_back(std::stod(svg.substr(svg.find(start, at) + start.size())));
  }
  ASSERT_EQ(heights.size(), 3u);
  EXPECT_NEAR(heights[1], 2 * heights[0], 0.02);
  EXPECT_EQ(heights[2], 0);
}

}  // namespace
}  // namespace sunder::scenes
