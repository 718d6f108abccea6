// Tests of the truths, and that their presets are those of scene files.
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "bench/truths/truth.h"
#include "scenes/file/schema.h"
#include "tests/truths/bounds.h"

namespace sunder::truths {
namespace {

const Truths& truths() {
  static const Truths kAll = all_truths();
  return kAll;
}

class AtPreset : public testing::TestWithParam<Case> {};

TEST_P(AtPreset, ATruthIsWithinItsBound) {
  const auto [index, preset] = GetParam();
  expect_within_bound(truths()[index], preset);
}

std::string name_of_case(const testing::TestParamInfo<Case>& one) {
  return name_of(truths()[std::get<0>(one.param)], std::get<1>(one.param));
}

INSTANTIATE_TEST_SUITE_P(All, AtPreset, all_of(truths()), name_of_case);

TEST(TruthRows, AreAllRun) { expect_rows(truths(), SUNDER_ROWS); }

/// A kind is found by the text of the source.
TEST(TruthSources, AreOfTheirKinds) {
  std::map<SourceKind, std::set<std::string>> sources;
  for (const Truth& truth : truths()) sources[source_kind(truth)].insert(truth.source);
  EXPECT_EQ(sources[SourceKind::kMeasured],
            (std::set<std::string>{"1.24 a, Lube et al. 2004", "Bennett and Borchelt, Texas Tech",
                                   "Børvik 1999", "Jarrett 1968", "de la Bastie, about 1876"}));
  EXPECT_EQ(sources[SourceKind::kOtherEngine].size(), 6u);
  EXPECT_EQ(sources[SourceKind::kOwn].size(), 10u);
  EXPECT_EQ(sources[SourceKind::kClosedForm].count("weight"), 1u);
  EXPECT_EQ(source_kind(truths().back()), SourceKind::kOwn) << "they are last";
}

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
