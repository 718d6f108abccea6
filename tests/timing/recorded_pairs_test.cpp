// Tests of the judgement on times that were recorded: pairs of runs of two copies of one program
// (recorded_pairs.txt). Commands are made of them by drawing pairs at random, so that they have the
// noise of a machine, the extremes, and figures that vary together.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "scenes/timing/judge.h"

namespace sunder::scenes {
namespace {

/// The recorded figures, by scene.
using Recorded = std::map<std::string, std::vector<PairedFigure>>;

/// Reads a file of which each line has scene, figure, unit ("_" for spaces), and value now and
/// before of each pair.
Recorded read_recorded() {
  std::ifstream in(SUNDER_RECORDED_PAIRS);
  Recorded recorded;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string scene;
    PairedFigure figure;
    words >> scene >> figure.what >> figure.figure >> figure.unit;
    std::ranges::replace(figure.unit, '_', ' ');
    for (double now = 0, before = 0; words >> now >> before;) {
      figure.now.push_back(now);
      figure.before.push_back(before);
    }
    recorded[scene].push_back(figure);
  }
  return recorded;
}

bool is_time(const PairedFigure& figure) { return figure.unit.starts_with("ms"); }

/// Returns the judgement of a command of `repeats` pairs. The pairs are drawn with replacement, the
/// same for all figures of a scene, and with `swap` the two programs are exchanged at random. Times
/// of this program are multiplied by `factor`.
Judgements command(const Recorded& recorded, std::size_t repeats, double factor, bool swap,
                   const std::string& fail_slower, std::uint64_t seed) {
  Random random(seed);
  std::vector<ScenePairs> scenes;
  for (const auto& [name, figures] : recorded) {
    std::vector<PairedFigure>& drawn = scenes.emplace_back(ScenePairs{name, figures}).figures;
    for (PairedFigure& figure : drawn) figure.now = figure.before = {};
    for (std::size_t i = 0; i < repeats; ++i) {
      const std::size_t pair = random.below(static_cast<std::uint32_t>(figures[0].now.size()));
      const bool is_swapped = random.below(2) == 1 && swap;
      for (std::size_t f = 0; f < figures.size(); ++f) {
        double now = figures[f].now[pair], before = figures[f].before[pair];
        if (is_swapped) std::swap(now, before);
        drawn[f].now.push_back(is_time(figures[f]) ? factor * now : now);
        drawn[f].before.push_back(before);
      }
    }
  }
  return judge(scenes,
               fail_slower.empty() ? std::nullopt : std::optional(parse_bounds("", fail_slower)));
}

struct Shares {
  double slower = 0;        ///< Share of commands that call a figure slower.
  double failed = 0;        ///< Share of commands that fail.
  double frame_failed = 0;  ///< Share of commands in which the mean time of a frame fails.
};

Shares shares(std::size_t repeats, double factor, bool swap, const std::string& fail_slower) {
  constexpr int kCommands = 400;
  static const Recorded recorded = read_recorded();
  Shares shares;
  for (int i = 0; i < kCommands; ++i) {
    const Judgements all =
        command(recorded, repeats, factor, swap, fail_slower, static_cast<std::uint64_t>(i));
    const auto any = [&](const auto& is_so) {
      return std::ranges::any_of(all.figures, is_so) ? 1.0 / kCommands : 0;
    };
    shares.slower +=
        any([](const Judged& figure) { return figure.judgement == Judgement::kSlower; });
    shares.failed += any([](const Judged& figure) { return figure.fails; });
    shares.frame_failed += any(
        [](const Judged& figure) { return figure.fails && figure.pair.name() == "frame mean"; });
  }
  return shares;
}

TEST(RecordedPairs, AreOfIdenticalProgramsNeitherOfWhichIsOftenTheSlower) {
  const Recorded recorded = read_recorded();
  ASSERT_EQ(recorded.size(), 2u);
  for (const auto& [scene, figures] : recorded) {
    EXPECT_EQ(figures.size(), kMaxPairedFiguresDrawn);
    for (const PairedFigure& figure : figures) {
      ASSERT_EQ(figure.now.size(), 40u);
      std::size_t more = 0, fewer = 0;
      for (std::size_t i = 0; i < 40; ++i) {
        more += figure.now[i] > figure.before[i] ? 1 : 0;
        fewer += figure.now[i] < figure.before[i] ? 1 : 0;
      }
      constexpr double kSides = 2 * 2 * kMaxPairedFiguresDrawn;  // of all figures of both scenes
      EXPECT_GT(heads_probability(std::max(more, fewer), more + fewer), kJudgeError / kSides)
          << scene << " " << figure.name() << ": " << more << " against " << fewer;
    }
  }
}

TEST(RecordedPairs, OfIdenticalProgramsFailInFewerCommandsThanStated) {
  for (const std::size_t repeats :
       {std::size_t{11}, std::size_t{kJudgedRepeats}, std::size_t{30}}) {
    EXPECT_LE(shares(repeats, 1, true, "0%").failed, kJudgeError) << repeats;
    EXPECT_LE(shares(repeats, 1, true, "").slower, kJudgeError) << repeats;
    EXPECT_LE(shares(repeats, 1, false, "5%").failed, kJudgeError) << repeats << ", as recorded";
  }
}

TEST(RecordedPairs, SlowerByTheirBoundFailInFewerCommandsThanStated) {
  EXPECT_LE(shares(kJudgedRepeats, 1.05, true, "5%").failed, kJudgeError);
  EXPECT_LE(shares(kJudgedRepeats, 1.10, true, "10%").failed, kJudgeError);
}

TEST(RecordedPairs, SlowerByMoreThanTheBoundFail) {
  EXPECT_GE(shares(kJudgedRepeats, 1.10, true, "3%").frame_failed, 0.95);
  EXPECT_GE(shares(kJudgedRepeats, 1.10, true, "5%").frame_failed, 0.9);
  EXPECT_GE(shares(kJudgedRepeats, 1.05, true, "").slower, 0.95);
  EXPECT_GE(shares(30, 1.10, true, "3%").frame_failed, 0.95);
  EXPECT_GE(shares(30, 1.10, true, "").slower, 0.95);
}

}  // namespace
}  // namespace sunder::scenes
