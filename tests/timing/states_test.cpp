// Tests of stored states, and the comparison of runs with them.
#include "scenes/timing/states.h"

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/timing/timing.h"
#include "tests/engine/markup.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;

const char* const kStored = "fedcba9876543210";  // of made_up_timings()

Verdict verdict_of(const Figures& scene, const StateHashes& book) {
  return compare_states(std::span(&scene, 1), book, "hashes.txt").front();
}

TEST(StateHashes, IsReadAsItWasWritten) {
  const StateHashes book = {{"state/house/realtime/200", "0123456789abcdef"}, {"x", kStored}};
  EXPECT_EQ(parse_hashes(format_hashes(book), "hashes.txt"), book);
  EXPECT_TRUE(parse_hashes("# nothing\n\n  \n", "hashes.txt").empty());
}

TEST(StateHashes, AWrongLineIsNamed) {
  const std::string fine = "x fedcba9876543210\n";
  for (const std::string wrong :
       {"y", "y 0123", "y 0123456789abcdeg", "y 0123456789abcdef more", "x 0123456789abcdef"}) {
    try {
      parse_hashes("# a comment\n" + fine + wrong + "\n", "hashes.txt");
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("hashes.txt:3: "), 0u) << error.what();
    }
  }
}

TEST(States, OneBitThatDiffersFails) {
  const StateHashes book = {{"state/house/realtime/200", kStored}};
  Figures scene = made_up_timings("house", 1);
  EXPECT_EQ(verdict_of(scene, book).outcome, Outcome::kPassed);
  scene["/state/hash"] = std::string("fedcba9876543211");
  const Verdict verdict = verdict_of(scene, book);
  EXPECT_EQ(verdict.outcome, Outcome::kFailed);
  for (const char* part : {"state/house/realtime/200", kStored, "fedcba9876543211", "--accept"}) {
    EXPECT_NE(verdict.text.find(part), std::string::npos) << part << ": " << verdict.text;
  }
}

TEST(States, AStateThatIsNotStoredFailsAndOneThatCannotBeStoredIsSkipped) {
  Figures scene = made_up_timings("house", 1);
  EXPECT_EQ(verdict_of(scene, {}).outcome, Outcome::kFailed);
  const StateHashes other = {{"state/house/draft/200", kStored},
                             {"state/house/realtime/100", kStored}};
  EXPECT_EQ(verdict_of(scene, other).outcome, Outcome::kFailed)
      << "the states are of another preset or length";
  scene["/set/0"] = std::string("limits.dust=0");
  EXPECT_EQ(verdict_of(scene, {}).outcome, Outcome::kSkipped);
  scene = made_up_timings("house", 1);
  scene.erase("/state/hash");
  EXPECT_EQ(verdict_of(scene, {}).outcome, Outcome::kSkipped);
}

TEST(States, DifferentRepeatsFailWhateverIsStored) {
  Figures scene = made_up_timings("house", 1);
  scene["/differs"] = true;
  StateHashes book = {{"state/house/realtime/200", kStored}};
  EXPECT_EQ(verdict_of(scene, book).outcome, Outcome::kFailed);
  EXPECT_THROW(accept_states(std::span(&scene, 1), book), InputError);
}

TEST(States, AnAcceptedStatePassesAndOtherEntriesStay) {
  StateHashes book = {{"state/house/realtime/200", "0123456789abcdef"}, {"pixels/house", kStored}};
  const Figures scene = made_up_timings("house", 1);
  EXPECT_EQ(verdict_of(scene, book).outcome, Outcome::kFailed);
  accept_states(std::span(&scene, 1), book);
  EXPECT_EQ(verdict_of(scene, book).outcome, Outcome::kPassed);
  EXPECT_EQ(book.size(), 2u);
  EXPECT_EQ(book.at("pixels/house"), kStored);
  Figures changed = scene;
  changed["/set/0"] = std::string("limits.dust=0");
  EXPECT_THROW(accept_states(std::span(&changed, 1), book), InputError);
}

TEST(Junit, CountsFailedAndSkippedChecks) {
  const Verdict verdicts[] = {{"house", "state", Outcome::kFailed, "a < b & \"c\"", 1.5},
                              {"house", "stage solve", Outcome::kPassed, "1 ms", 0.25},
                              {"glass", "state", Outcome::kSkipped, "too short"}};
  const std::string xml = junit_xml("bench", verdicts);
  EXPECT_EQ(tests::markup_mistake(xml.substr(xml.find('\n'))), "");
  for (const char* part :
       {"tests=\"3\" failures=\"1\" skipped=\"1\"", "<testsuite name=\"house\" tests=\"2\"",
        "<failure message=\"a &lt; b &amp; &quot;c&quot;\"/>", "<skipped message=\"too short\"/>",
        "skipped=\"0\" time=\"1.750\"", "name=\"stage solve\" time=\"0.250\""}) {
    EXPECT_NE(xml.find(part), std::string::npos) << part << "\n" << xml;
  }
}

}  // namespace
}  // namespace sunder::scenes
