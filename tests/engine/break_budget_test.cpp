// Tests of the budget of breaks of a frame.
#include <gtest/gtest.h>

#include "engine/world/break/break_stage.h"

namespace sunder {
namespace {

TEST(BreakBudget, EvaluationsAndNewBodiesUseTheBudgetButOneBreakIsAlwaysAccepted) {
  BreakBudget budget(10);
  budget.begin_frame();
  budget.charge(100);
  EXPECT_FALSE(budget.spent()) << "or a frame of much to look at would break nothing";
  EXPECT_TRUE(budget.try_spend(50));
  EXPECT_TRUE(budget.spent());
  EXPECT_FALSE(budget.try_spend(1));
  budget.begin_frame();
  budget.charge(4);
  EXPECT_TRUE(budget.try_spend(6));
  EXPECT_FALSE(budget.try_spend(1)) << "4 are gone";
}

}  // namespace
}  // namespace sunder
