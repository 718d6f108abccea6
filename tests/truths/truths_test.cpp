// Every truth at every preset, within the bound it reaches; a missed mark is printed.
#include <cctype>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "bench/truths/truth.h"
#include "scenes/file/schema.h"

namespace sunder::truths {
namespace {

const Truths& truths() {
  static const Truths kAll = all_truths();
  return kAll;
}

/// A number of truths() and one of kPresets.
using Case = std::tuple<std::size_t, std::size_t>;
class AtPreset : public testing::TestWithParam<Case> {};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  const auto& truth = truths()[std::get<0>(info.param)];
  std::string name = "Row" + std::to_string(truth.row);
  bool word = true;
  for (const char* c = truth.what; *c; ++c) {
    const bool part = std::isalnum(static_cast<unsigned char>(*c)) != 0 && *c > 0;
    if (part && word) name += '_';
    if (part) name += *c;
    word = !part;
  }
  return name + "_" + kPresets[std::get<1>(info.param)].name;
}

TEST_P(AtPreset, ATruthIsWithinItsBound) {
  const auto [index, preset] = GetParam();
  const auto& truth = truths()[index];
  if (!truth.measure) GTEST_SKIP() << "not measured yet";
  if (preset >= truth.tested) GTEST_SKIP() << "by truths_bench alone";
  const double value = truth.measure(kPresets[preset]);
  std::printf("%d %s, %s: %.3g %s (mark %g%s)\n", truth.row, truth.what, kPresets[preset].name,
              value, truth.unit, truth.mark, std::abs(value) <= truth.mark ? "" : ", missed");
  EXPECT_LE(std::abs(value), truth.bounds[preset]);
}

INSTANTIATE_TEST_SUITE_P(All, AtPreset,
                         testing::Combine(testing::Range(std::size_t{0}, truths().size()),
                                          testing::Range(std::size_t{0}, kPresets.size())),
                         name_of);

TEST(TruthPresets, AreThoseOfSceneFiles) {
  const auto presets = scenes::presets();
  ASSERT_EQ(presets.size(), kPresets.size());
  for (std::size_t i = 0; i < presets.size(); ++i) {
    EXPECT_EQ(presets[i].name, kPresets[i].name);
    EXPECT_EQ(presets[i].accuracy.dt_s, kPresets[i].dt_s);
    EXPECT_EQ(presets[i].accuracy.substeps, kPresets[i].substeps);
    EXPECT_EQ(presets[i].sweeps, kPresets[i].sweeps);
  }
}

}  // namespace
}  // namespace sunder::truths
