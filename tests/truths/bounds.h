// Tests of the truths of a list at every preset: each is within its bound; missed marks are
// printed.
#pragma once

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

inline void expect_within_bound(const Truth& truth, std::size_t preset) {
  const double value = truth.measure(kPresets[preset]);
  std::printf("%d %s, %s: %.3g %s (mark %g%s)\n", truth.row, truth.what, kPresets[preset].name,
              value, truth.unit, truth.mark, std::abs(value) <= truth.mark ? "" : ", missed");
  EXPECT_LE(std::abs(value), truth.bounds[preset]);
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
inline void expect_rows(const Truths& truths, int rows) { EXPECT_EQ(truths.back().row, rows); }

}  // namespace sunder::truths
