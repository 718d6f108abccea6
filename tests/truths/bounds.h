// Tests of the truths of a list at every preset: each reaches its mark or is a known failure.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "bench/truths/truth.h"

namespace sunder::truths {

/// Index of a truth in its list, and of a preset in kPresets.
using Case = std::tuple<std::size_t, std::size_t>;

inline std::string name_of(const Truth& truth, std::size_t preset) {
  std::string name = "Row" + std::to_string(truth.row);
  bool starts_word = true;
  for (const char* c = truth.what; *c; ++c) {
    const bool is_word_character = std::isalnum(static_cast<unsigned char>(*c)) != 0 && *c > 0;
    if (is_word_character && starts_word) name += '_';
    if (is_word_character) name += *c;
    starts_word = !is_word_character;
  }
  return name + "_" + kPresets[preset].name;
}

/// Checks a truth at a preset. Its mark is asserted, or a tighter bound. A bound above the mark is
/// a known failure: it may not become worse than its bound, and when it reaches the mark or half of
/// the bound, the bound is to be lowered.
inline void expect_within_bound(const Truth& truth, std::size_t preset) {
  const double value = std::abs(truth.measure(kPresets[preset])), bound = truth.bounds[preset];
  const bool is_known_failure = bound > truth.mark;
  std::printf("%d %s, %s: %.3g %s (mark %g%s)\n", truth.row, truth.what, kPresets[preset].name,
              value, truth.unit, truth.mark, is_known_failure ? ", a known failure" : "");
  EXPECT_LE(value, bound) << (is_known_failure ? "worse than the known failure"
                                               : "misses its bound");
  if (!is_known_failure) return;
  EXPECT_GT(value, truth.mark) << "reaches its mark: no longer a known failure, lower its bound";
  if (value < 0.5 * bound)
    std::printf("  better than the known failure: lower its bound of %g\n", bound);
}

inline auto all_of(const Truths& truths) {
  std::vector<std::size_t> tested;
  for (std::size_t i = 0; i < truths.size(); ++i)
    if (!truths[i].is_timing) tested.push_back(i);
  return testing::Combine(testing::ValuesIn(tested),
                          testing::Range(std::size_t{0}, kPresets.size()));
}

/// Checks the number of rows, for each of which ctest has one entry (tests/truths/CMakeLists.txt),
/// so that measurements shared by truths of a row are made once.
inline void expect_rows(const Truths& truths, int rows) {
  EXPECT_EQ(std::ranges::max(truths, {}, &Truth::row).row, rows);
}

}  // namespace sunder::truths
