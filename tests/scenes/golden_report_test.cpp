// Tests of the report page of golden tests.
#include "scenes/report/golden_report.h"

#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/markup.h"

namespace sunder::scenes {
namespace {

render::Image flat(std::uint8_t level) {
  return {40, 40, std::vector<std::uint8_t>(std::size_t{3} * 40 * 40, level)};
}

GoldenResult picture(const std::string& name, std::uint8_t reference, std::uint8_t actual) {
  GoldenResult p;
  p.name = name;
  p.reference = flat(reference);
  p.actual = flat(actual);
  p.difference = render::compare(p.reference, p.actual);
  p.passed = p.difference.passes(p.thresholds);
  p.accept_command = "sunder golden accept " + name;
  return p;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(GoldenReport, FailuresComeFirstWithTheCommandThatAcceptsThem) {
  const std::vector<GoldenResult> pictures = {picture("good", 90, 90), picture("b<a>d", 90, 200)};
  const std::string page = golden_report(pictures);
  EXPECT_LT(page.find("b&lt;a>d"), page.find("good"));
  EXPECT_EQ(count(page, "sunder golden accept"), 1u) << "a picture that passed has no command";
  EXPECT_EQ(count(page, "class=\"over\""), 2u) << "both figures are over their limits";
}

TEST(GoldenReport, ThePageEmbedsItsPicturesAndLoadsNothingElse) {
  const std::vector<GoldenResult> pictures = {picture("good", 90, 90), picture("bad", 90, 200)};
  const std::string page = golden_report(pictures);
  EXPECT_EQ(count(page, "data:image/png;base64,"), 4u)
      << "one image where both are equal, else three";
  EXPECT_EQ(count(page, "http"), 0u);
  EXPECT_EQ(tests::markup_mistake(page), "");
  for (const char* part : {"id=\"lens\"", "image-rendering: pixelated", "function magnify(",
                           "value=\"slider\"", "setInterval("}) {
    EXPECT_EQ(count(page, part) >= 1, true) << part;
  }
}

TEST(GoldenReport, PicturesAreListedByTheirDistanceFromTheOriginals) {
  std::vector<GoldenResult> pictures = {picture("same", 90, 90), picture("near", 90, 90),
                                        picture("far", 90, 90)};
  for (GoldenResult& p : pictures) p.from_original = render::compare(p.reference, p.actual);
  EXPECT_NE(golden_report(pictures).find("Every picture is equal to its original"),
            std::string::npos);
  pictures[1].original = flat(91);
  pictures[2].original = flat(93);
  pictures[2].rebased = "a <new> sky";
  for (GoldenResult& p : std::span(pictures).subspan(1))
    p.from_original = render::compare(p.original, p.actual);
  const std::string page = golden_report(pictures);
  const std::size_t table = page.find("<h2>Distance from the originals"),
                    end = page.find("<section", table);
  const std::string rows = page.substr(table, end - table);
  EXPECT_LT(rows.find("far"), rows.find("near"));
  EXPECT_EQ(rows.find("same"), std::string::npos);
  EXPECT_NE(page.find("a &lt;new> sky"), std::string::npos);
  EXPECT_EQ(tests::markup_mistake(page), "");
}

TEST(GoldenReport, AMissingBaselineIsReplacedByTheNewPicture) {
  GoldenResult p;
  p.name = "new";
  p.actual = flat(50);
  p.accept_command = "sunder golden accept new";
  const std::string page = golden_report(std::vector<GoldenResult>{p});
  EXPECT_EQ(count(page, "data:image/png;base64,"), 1u);
  EXPECT_EQ(count(page, "sunder golden accept new"), 1u);
}

}  // namespace
}  // namespace sunder::scenes
