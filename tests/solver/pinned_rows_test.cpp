// Tests of the equations of joint impulses: solutions, also after changes of some rows, and bounds.
#include "solver/rigid/joint/pinned_rows.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::solver {
namespace {

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// Returns a positive definite matrix of rows that begin up to `width` columns before the diagonal.
Envelope matrix(std::uint32_t rows, std::uint32_t width, Random& random) {
  Envelope e;
  e.start = {0};
  for (std::uint32_t i = 0; i < rows; ++i) {
    e.first.push_back(i > width ? i - width : 0);
    e.start.push_back(e.start.back() + i + 1 - e.first.back());
  }
  e.entries.assign(e.start.back() + Envelope::kPadding, 0);
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t k = e.first[i]; k < i; ++k) e.at(i, k) = between(random, -1, 1);
    e.at(i, i) = 2 * width + 2;
  }
  return e;
}

std::vector<double> numbers(std::size_t count, Random& random) {
  std::vector<double> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(between(random, -1, 1));
  return all;
}

TEST(Envelope, SolvesForTheFactorOfTheProduct) {
  Random random(1);
  for (std::uint32_t rows = 1; rows < 70; ++rows) {
    const Envelope given = matrix(rows, rows % 23, random);
    const std::vector<double> x = numbers(rows, random);
    std::vector<double> solved = given.times(x);
    Envelope factored = given;
    factored.factor();
    factored.solve(solved);
    for (std::uint32_t i = 0; i < rows; ++i) EXPECT_NEAR(solved[i], x[i], 1e-13) << rows;
    // The rows from the middle on again, from those before.
    Envelope again = given;
    const std::uint32_t from = rows / 2;
    std::copy_n(factored.entries.begin(), factored.start[from], again.entries.begin());
    again.factor(from);
    EXPECT_EQ(again.entries, factored.entries) << rows;
  }
}

/// Expects the minimum within bounds: no excess of a free row, and none that would leave its bound.
/// With more rows that meet a bound than there are rounds, expects that no energy is made.
TEST(PinnedRows, FindsTheMinimumWithinBounds) {
  Random random(2);
  std::size_t pinned = 0;
  for (std::uint32_t rows = 1; rows < 70; ++rows) {
    const Envelope response = matrix(rows, rows % 17, random);
    PinnedRows group;
    group.bounds.resize(rows);
    for (RowBounds& row : group.bounds) row.least = -0.3, row.most = 0.4;
    for (int call = 0; call < 3; ++call) {  // later ones reuse the factor
      const std::vector<double> target = response.times(numbers(rows, random));
      std::vector<double> change = target;
      group.solve(response, change);
      const std::vector<double> product = response.times(change);
      double energy = 0;
      for (std::uint32_t i = 0; i < rows; ++i) energy += change[i] * (product[i] / 2 - target[i]);
      EXPECT_LT(energy, 0) << rows;
      for (std::uint32_t i = 0; i < rows; ++i) {
        const double excess = product[i] - target[i];
        EXPECT_GE(change[i], -0.3 - 1e-9);
        EXPECT_LE(change[i], 0.4 + 1e-9);
        const bool low = change[i]<-0.3 + 1e-9, high = change[i]> 0.4 - 1e-9;
        pinned += low || high;
        if (rows > 32) continue;
        EXPECT_TRUE(low || excess < 1e-9) << rows << " rows, row " << i;
        EXPECT_TRUE(high || excess > -1e-9) << rows << " rows, row " << i;
      }
    }
  }
  EXPECT_GT(pinned, 1000u);
}

}  // namespace
}  // namespace sunder::solver
