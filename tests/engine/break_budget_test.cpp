// Tests of the budget of breaks of a frame.
#include <gtest/gtest.h>

#include "engine/world/break/break_stage.h"

namespace sunder {
namespace {

TEST(BreakBudget, EvaluationsAndNewBodiesUseTheBudgetButOneBreakIsAlwaysAccepted) {
  BreakBudget budget(10);
  budget.begin_frame();
  budget.charge(100);
  EXPECT_FALSE(budget.spent()) << "one break is accepted although evaluations have used the budget";
  EXPECT_TRUE(budget.try_spend(50));
  EXPECT_TRUE(budget.spent());
  EXPECT_FALSE(budget.try_spend(1));
  budget.begin_frame();
  budget.charge(4);
  EXPECT_TRUE(budget.try_spend(6));
  EXPECT_FALSE(budget.try_spend(1)) << "4 of 10 are spent";
}

}  // namespace
}  // namespace sunder
