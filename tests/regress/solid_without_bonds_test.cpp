// Symptom: a run crashed where a load pressed on a piece of one convex. Cause: without springs
// between nodes, a direct solve counted as dearer than the iterations that it replaces, and a
// coarser level had no groups at all. Fixed in 3f188c8.
#include <gtest/gtest.h>

#include "tests/fracture/frames.h"

namespace sunder::fracture {
namespace {

TEST(RegressStress, ASolidWithoutBondsBearsAnyLoad) {
  for (const int boxes : {1, 2, 1200}) {
    std::vector<Part> parts;
    for (int i = 0; i < boxes; ++i)
      add_grid(Vec3(2 * i, 0, 0), Vec3(2 * i + 1, 1, 1), 1, 1, 1, false, parts);
    const Compound compound = make_compound(std::move(parts));
    ASSERT_TRUE(compound.bonds.empty());
    const std::vector<Material> materials = stone(1e5);
    const Load press{ConvexSlot(0), Vec3(0, -1e9, 0), Vec3(0.5, 1, 0.5)};
    LoadCase load;
    load.materials = materials;
    load.gravity_R = kDown;
    load.most_work = std::uint64_t{1} << 40;
    load.loads = std::span(&press, 1);
    const StressAnswer answer = break_by_stress(Structure(compound), load);
    EXPECT_TRUE(answer.settled);
    EXPECT_TRUE(answer.edit.cut.empty());
  }
}

}  // namespace
}  // namespace sunder::fracture
