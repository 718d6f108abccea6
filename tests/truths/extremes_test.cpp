// Tests of the extremes, scenes that ask for more than the solver is accurate for: each is within
// its bound in docs/extremes.md, and warns the user where that bound is above the mark.
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "bench/extremes/extreme.h"
#include "tests/truths/bounds.h"

namespace sunder::truths {
namespace {

const Truths& extremes() {
  static const Truths kAll = all_extremes();
  return kAll;
}

class ExtremeAtPreset : public testing::TestWithParam<Case> {};

TEST_P(ExtremeAtPreset, IsWithinItsBound) {
  const auto [index, preset] = GetParam();
  expect_within_bound(extremes()[index], preset);
}

std::string name_of_case(const testing::TestParamInfo<Case>& one) {
  return name_of(extremes()[std::get<0>(one.param)], std::get<1>(one.param));
}

INSTANTIATE_TEST_SUITE_P(All, ExtremeAtPreset, all_of(extremes()), name_of_case);

TEST(ExtremeRows, AreAllRun) { expect_rows(extremes(), SUNDER_ROWS); }

TEST(Extremes, WarnWhereTheirBoundIsAboveTheMark) {
  for (const Truth& extreme : extremes()) {
    if (extreme.is_timing) continue;
    for (std::size_t preset = 0; preset < kPresets.size(); ++preset) {
      if (extreme.bounds[preset] <= extreme.mark) continue;
      EXPECT_NE(extreme.told(kPresets[preset]), "")
          << extreme.what << ", " << kPresets[preset].name;
    }
  }
}

}  // namespace
}  // namespace sunder::truths
