// Every truth of a list at every preset, within the bound it reaches; a missed mark is printed.
#pragma once

#include <cctype>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "bench/truths/truth.h"

namespace sunder::truths {

/// A number of a list's and one of kPresets.
using Case = std::tuple<std::size_t, std::size_t>;

inline std::string name_of(const Truth& truth, std::size_t preset) {
  std::string name = "Row" + std::to_string(truth.row);
  bool word = true;
  for (const char* c = truth.what; *c; ++c) {
    const bool part = std::isalnum(static_cast<unsigned char>(*c)) != 0 && *c > 0;
    if (part && word) name += '_';
    if (part) name += *c;
    word = !part;
  }
  return name + "_" + kPresets[preset].name;
}

inline void expect_within_bound(const Truth& truth, std::size_t preset) {
  if (!truth.measure) GTEST_SKIP() << "not measured yet";
  if (preset >= truth.tested) GTEST_SKIP() << "by the bench alone";
  const double value = truth.measure(kPresets[preset]);
  std::printf("%d %s, %s: %.3g %s (mark %g%s)\n", truth.row, truth.what, kPresets[preset].name,
              value, truth.unit, truth.mark, std::abs(value) <= truth.mark ? "" : ", missed");
  EXPECT_LE(std::abs(value), truth.bounds[preset]);
}

inline auto all_of(std::size_t truths) {
  return testing::Combine(testing::Range(std::size_t{0}, truths),
                          testing::Range(std::size_t{0}, kPresets.size()));
}

}  // namespace sunder::truths
