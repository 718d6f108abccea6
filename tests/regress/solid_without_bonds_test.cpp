// Symptom: a run crashed when a load acted on a solid that had no springs left. Cause: without
// springs between nodes, a direct solve was estimated to cost more than the iterations that it
// replaces, and a coarser level had no groups at all. Fixed in 3f188c8.
#include <gtest/gtest.h>

#include "fracture/stress/multigrid.h"

namespace sunder::fracture {
namespace {

TEST(RegressStress, NodesWithoutSpringsAreSolvedEachOnItsOwn) {
  for (const std::size_t nodes : {std::size_t{1}, std::size_t{2}, std::size_t{1200}}) {
    const Multigrid multigrid(nodes, std::vector<Spring>());
    EXPECT_EQ(multigrid.springs().size(), nodes);
  }
}

}  // namespace
}  // namespace sunder::fracture
