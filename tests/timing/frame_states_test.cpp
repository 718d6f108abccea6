// Tests of stored states of single frames, and the comparison of runs with them.
#include "scenes/timing/frame_states.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "engine/base/check.h"

namespace sunder::scenes {
namespace {

const std::vector<std::uint64_t> kRun = {0x1111222233334444, 0x5555666677778888,
                                         0x99990000aaaabbbb};

/// Ten boxes at rest: nothing breaks.
const GuardedRun kStack = {"boxes", "stack", {}, 3};

TEST(FrameStates, TheFirstDifferentFrameIsNamed) {
  const std::string known = frame_digits(kRun);
  EXPECT_EQ(known, "111155559999");
  EXPECT_EQ(first_difference(known, kRun), std::nullopt);
  for (std::size_t frame = 0; frame < kRun.size(); ++frame) {
    std::vector<std::uint64_t> other = kRun;
    for (std::size_t i = frame; i < other.size(); ++i) other[i] ^= std::uint64_t{1} << 48;
    EXPECT_EQ(first_difference(known, other), static_cast<int>(frame));
  }
}

TEST(FrameStates, AShorterRunDiffersAndALongerOneDoesNot) {
  const std::string known = frame_digits(kRun);
  EXPECT_EQ(first_difference(known, std::span(kRun).first(2)), 2);
  std::vector<std::uint64_t> longer = kRun;
  longer.push_back(7);
  EXPECT_EQ(first_difference(known, longer), std::nullopt);
}

TEST(FrameStates, AcceptedStatesPassAtEveryPreset) {
  StateHashes book;
  accept_frames(kStack, book);
  EXPECT_EQ(book.size(), 4u);
  EXPECT_EQ(book.at("frames/boxes/draft").size(), 16u) << "frames 0 to 3";
  EXPECT_EQ(parse_hashes(format_hashes(book), "hashes.txt"), book);
  for (const Verdict& verdict : compare_frames(kStack, book, "hashes.txt", false).verdicts) {
    EXPECT_EQ(verdict.outcome, Outcome::kPassed) << verdict.what << " " << verdict.text;
  }
}

TEST(FrameStates, ABreakBeforeTheScriptDoesNotEndTheRunBeforeTheScript) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "early_break.toml";
  const auto accepted = [&](const std::string& shot) {
    std::ofstream(file) << "[scene]\ndescription = \"A brick bursts, then a ball comes.\"\n"
                           "duration_s = 2\n[[solid]]\nstructure = \"box\"\nmaterial = \"clay\"\n"
                           "size_m = [0.3, 0.3, 0.3]\nposition = [0, 0.05, 0]\n"
                           "velocity = [0, -30, 0]\n"
                        << shot;
    StateHashes book;
    accept_frames({"early", file.string(), {}, 3}, book);
    return book;
  };
  const auto frames = [](const StateHashes& book, const std::string& preset) {
    return book.at("frames/early/" + preset).size() / 4;
  };
  const StateHashes alone = accepted("");
  ASSERT_LT(frames(alone, "draft"), 15u) << "the brick breaks in the first frames";
  ASSERT_LT(frames(alone, "realtime"), 60u);
  StateHashes drawn;
  accept_frames({"early", file.string(), {}, 90, true}, drawn);
  EXPECT_EQ(frames(drawn, "realtime"), 91u) << "to the frame that is drawn";
  EXPECT_EQ(frames(drawn, "draft"), frames(alone, "draft"));
  const std::string shot =
      "[[script.shot]]\ntime_s = 0.5\nfrom = [2, 1, 2]\nat = [0, 0.5, 0]\nradius_m = 0.1\n";
  const StateHashes slow = accepted(shot + "speed_m_s = 5\n"),
                    fast = accepted(shot + "speed_m_s = 9\n");
  for (const char* preset : {"draft", "realtime", "accurate", "reference"}) {
    EXPECT_GE(frames(slow, preset), 39u) << "30 until the shot, and 8 more, at " << preset;
    EXPECT_NE(slow.at(std::string("frames/early/") + preset),
              fast.at(std::string("frames/early/") + preset))
        << preset;
  }
  std::filesystem::remove(file);
}

TEST(FrameStates, ADifferentDigitFailsAtItsPresetOnly) {
  StateHashes book;
  accept_frames(kStack, book);
  char& digit = book.at("frames/boxes/draft")[9];
  digit = digit == '0' ? '1' : '0';
  for (const Verdict& verdict : compare_frames(kStack, book, "hashes.txt", false).verdicts) {
    const bool changed = verdict.what == "simulation at draft";
    EXPECT_EQ(verdict.outcome, changed ? Outcome::kFailed : Outcome::kPassed) << verdict.what;
    if (!changed) continue;
    EXPECT_EQ(verdict.text, "differs from frame 2 on");
  }
}

TEST(FrameStates, TheFrameIsSameUnlessAStateUpToItDiffersOrIsNotStored) {
  StateHashes right;
  accept_frames(kStack, right);
  const auto compare = [&](int frame, const std::function<void(std::string&)>& change) {
    StateHashes book = right;
    change(book.at("frames/boxes/realtime"));
    GuardedRun run = kStack;
    run.frame = frame;
    return compare_frames(run, book, "hashes.txt", false);
  };
  const auto none = [](std::string&) {};
  const auto change_frame_2 = [](std::string& digits) { digits[8] = digits[8] == '0' ? '1' : '0'; };
  EXPECT_EQ(compare(3, none).frame->index, 3u);
  EXPECT_TRUE(compare(3, none).is_same);
  EXPECT_TRUE(compare(1, change_frame_2).is_same);
  EXPECT_FALSE(compare(2, change_frame_2).is_same);
  EXPECT_FALSE(compare(3, change_frame_2).is_same);
  const FrameComparison shorter = compare(3, [](std::string& digits) { digits.resize(12); });
  EXPECT_FALSE(shorter.is_same);
  EXPECT_EQ(shorter.frame, nullptr);
}

TEST(FrameStates, ARunWithoutStoredStatesFails) {
  const std::vector<Verdict> verdicts = compare_frames(kStack, {}, "hashes.txt", false).verdicts;
  ASSERT_EQ(verdicts.size(), 1u);
  EXPECT_EQ(verdicts.front().outcome, Outcome::kFailed);
}

TEST(FrameStates, WholeRunsAreComparedWithTheStatesOfBench) {
  StateHashes book;
  accept_frames(kStack, book);
  book["state/stack/draft/5"] = "0123456789abcdef";
  const auto failed = [&](const GuardedRun& run, bool whole) {
    const std::vector<Verdict> verdicts = compare_frames(run, book, "hashes.txt", whole).verdicts;
    return std::ranges::count(verdicts, Outcome::kFailed, &Verdict::outcome);
  };
  EXPECT_EQ(failed(kStack, false), 0);
  EXPECT_EQ(failed(kStack, true), 1);
  GuardedRun changed = kStack;
  changed.load.set = {"limits.dust=1"};
  EXPECT_EQ(failed(changed, true), 0) << "bench has states of the unchanged scene only";
  book["state/stack/draft/five"] = "0123456789abcdef";
  book.erase("state/stack/draft/5");
  EXPECT_THROW(compare_frames(kStack, book, "hashes.txt", true), InputError);
}

}  // namespace
}  // namespace sunder::scenes
