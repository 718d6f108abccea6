// Tests of the command `sunder trade`: a study that is killed, shared or completed later has the
// files of an uninterrupted one.
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "scenes/file/text_file.h"
#include "tests/engine/markup.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

namespace fs = std::filesystem;

const std::string kPile = SUNDER_ROOT "/bench/trade/scenes/pile.toml";

/// Returns the options of a study of three points and two seeds: six runs per scene. Steps of the
/// limit are as long as a frame, so that no coarser limit is added.
std::string small_study(const Folder& folder) {
  std::ofstream(folder / "points.txt")
      << "draft draft\nrealtime realtime\nlimit draft accuracy.substeps=16\n";
  return kPile + " --points " + folder / "points.txt" + " --seeds 2 --frames 20 --quiet ";
}

/// Returns the text of every file below a folder, by relative path.
std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = scenes::read_text(entry.path());
  }
  return files;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Trade, WrongUseExitsWithTwoAndSaysWhy) {
  const Folder folder;
  std::ofstream(folder / "bad.txt") << "draft draft\nlimit reference accuracy.substep=8\n";
  const std::string to = " -o " + folder / "out";
  for (const std::string& wrong :
       {std::string("trade"), std::string("trade stack"), "trade nowhere" + to,
        "trade stack --seeds 0" + to, "trade stack --shard 3/2" + to,
        "trade stack --merge --shard 1/2" + to, "trade stack --points nowhere.txt" + to,
        "trade stack --points " + folder / "bad.txt" + to, "trade stack --set nothing=1" + to,
        "trade stack --switch dust" + to, "trade stack --pool 8" + to, "trade stack --equal 0" + to,
        "trade stack --equal 9 --seeds 1" + to, "trade stack --equal 9 --seeds 4 --pool 7" + to}) {
    const Outcome outcome = sunder(wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong << "\n" << outcome.err;
    EXPECT_NE(outcome.err, "") << wrong;
  }
  EXPECT_FALSE(fs::exists(folder / "out")) << "nothing runs before all of the input is known good";
}

TEST(Trade, ListsItsRunsAndEveryShare) {
  const auto all = lines_of(sunder("trade stack --seeds 2 --list").out);
  ASSERT_EQ(all.size(), 30u);
  EXPECT_EQ(all[0], "stack/draft-1  draft scene.seed=1");
  EXPECT_EQ(all[17], "stack/60x4-2  draft accuracy.substeps=4 scene.seed=2");
  std::multiset<std::string> shared;
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    for (const std::string& line :
         lines_of(sunder(std::string("trade stack --seeds 2 --list --shard ") + shard).out)) {
      shared.insert(line);
    }
  }
  EXPECT_EQ(shared, std::multiset<std::string>(all.begin(), all.end()));
}

TEST(Trade, KilledAndResumedHasTheFilesOfAnUninterruptedStudy) {
  const Folder folder;
  const std::string study = small_study(folder);
  const std::string whole = folder / "whole", killed = folder / "killed";
  const Outcome outcome = sunder("trade " + study + "-o " + whole);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  // Kills the study as soon as the first run has its file.
  sunder("list --quiet", "\"" SUNDER_PROGRAM "\" trade " + study + "-o " + killed +
                             " & until [ -e " + killed +
                             "/runs/pile/draft-1.json ]; do sleep 0.01; done; "
                             "kill -9 $!; wait; ");
  fs::remove(fs::path(killed) / "runs/pile/draft-1.json");
  const Outcome resumed = sunder("trade " + study + "-o " + killed);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  const auto expected = files_in(fs::path(whole) / "runs");
  EXPECT_EQ(expected.size(), 6u);
  EXPECT_EQ(files_in(fs::path(killed) / "runs"), expected);
}

TEST(Trade, SharesMakeTheFilesOfTheWholeAndAreMerged) {
  const Folder folder;
  const std::string study = small_study(folder);
  const std::string whole = folder / "whole", shared = folder / "shared";
  ASSERT_EQ(sunder("trade " + study + "-o " + whole).exit_code, 0);
  ASSERT_EQ(sunder("trade " + study + "--shard 1/2 --threads 2 -o " + shared).exit_code, 0);
  EXPECT_FALSE(fs::exists(fs::path(shared) / "trade.html"));

  const Outcome gaps = sunder("trade " + study + "--merge -o " + shared);
  EXPECT_EQ(gaps.exit_code, 1);
  EXPECT_EQ(lines_of(gaps.err),
            (std::vector<std::string>{
                "missing: pile/realtime-1", "missing: pile/draft-2", "missing: pile/limit-2",
                "failed: 3 of 6 runs are missing; run the same command again to complete them"}));
  for (const char* file : {"trade.csv", "trade.json", "trade.html", "pile.svg"}) {
    EXPECT_TRUE(fs::exists(fs::path(shared) / file)) << file;
  }

  ASSERT_EQ(sunder("trade " + study + "--shard 2/2 -o " + shared).exit_code, 0);
  const Outcome merged = sunder("trade " + study + "--merge -o " + shared);
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(files_in(fs::path(shared) / "runs"), files_in(fs::path(whole) / "runs"));
  EXPECT_EQ(markup_mistake(scenes::read_text(fs::path(shared) / "trade.html")), "");
  EXPECT_EQ(markup_mistake(scenes::read_text(fs::path(shared) / "pile.svg")), "");
}

TEST(Trade, ComparesGroupsOfEqualRuns) {
  const Folder folder;
  const std::string equal = kPile + " --equal 20 --seeds 2 --frames 20 ";
  const auto list = lines_of(sunder("trade " + equal + "--list").out);
  ASSERT_EQ(list.size(), 8u) << "four times the seeds";
  EXPECT_EQ(list[7], "pile/realtime-8  realtime scene.seed=8");
  const std::string to = "-o " + folder / "out";
  const Outcome part = sunder("trade " + equal + "--pool 4 --shard 1/2 --quiet " + to);
  EXPECT_EQ(part.exit_code, 0) << part.err;
  const Outcome gaps = sunder("trade " + equal + "--pool 4 --merge " + to);
  EXPECT_EQ(gaps.exit_code, 1);
  EXPECT_NE(gaps.err.find("missing: pile/realtime-2\n"), std::string::npos) << gaps.err;
  const Outcome whole = sunder("trade " + equal + "--pool 4 --json - " + to);
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_NE(whole.out.find("\"pairs\": 20"), std::string::npos) << whole.out;
  EXPECT_NE(whole.out.find("\"differ\": 0"), std::string::npos) << "two runs are never certain";
  EXPECT_EQ(scenes::read_text(folder / "out/equal.json"), whole.out);
}

TEST(Trade, AFinishedRunIsNotRepeatedUnlessItIsOfAnotherStudy) {
  const Folder folder;
  const std::string study = small_study(folder) + "-o " + folder / "out ";
  ASSERT_EQ(sunder("trade " + study).exit_code, 0);
  const auto times = files_in(folder / "out/times");
  const Outcome again = sunder("trade " + study);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "");
  EXPECT_EQ(files_in(folder / "out/times"), times) << "no run was timed again";

  fs::resize_file(folder / "out/runs/pile/limit-1.json", 50);
  std::ofstream(folder / "points.txt") << "draft draft\nrealtime realtime ground.friction=0.3\n"
                                          "limit draft accuracy.substeps=16\n";
  const Outcome other = sunder("trade " + study);
  EXPECT_EQ(other.exit_code, 0);
  const auto said = lines_of(other.err);
  ASSERT_EQ(said.size(), 3u) << other.err;
  EXPECT_EQ(said[0], "pile/realtime-1: belongs to another study; run again");
  EXPECT_NE(said[1].find("limit-1.json: not a JSON document; run again"), std::string::npos);
  EXPECT_EQ(said[2], "pile/realtime-2: belongs to another study; run again");
}

}  // namespace
}  // namespace sunder::tests
