// Writes after each test the numbers of the mutants whose lines it ran, to the file SUNDER_REACH:
// one line for each test, with its name, milliseconds of processor time, and the numbers.
#pragma once

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/mutation/mutant.h"

namespace sunder::mutants {

class Reach : public testing::EmptyTestEventListener {
 public:
  explicit Reach(const char* path) : file_(path, std::ios::app) {}

 private:
  void OnTestStart(const testing::TestInfo&) override {
    std::memset(reached, 0, sizeof(reached));
    start_ = std::clock();
  }
  void OnTestEnd(const testing::TestInfo& test) override {
    file_ << test.test_suite_name() << '.' << test.name() << ' '
          << 1000 * (std::clock() - start_) / CLOCKS_PER_SEC;
    for (int k = 0; k < kMaxMutants; ++k)
      if (reached[k]) file_ << ' ' << k;
    file_ << std::endl;
  }

  std::ofstream file_;
  std::clock_t start_ = 0;
};

inline const bool is_listening = [] {
  if (const char* path = std::getenv("SUNDER_REACH"))
    testing::UnitTest::GetInstance()->listeners().Append(new Reach(path));
  return true;
}();

}  // namespace sunder::mutants
