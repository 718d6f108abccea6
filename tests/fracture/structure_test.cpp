// Tests that a structure after any number of edits equals one rebuilt from the remaining convexes.
#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/islands.h"
#include "fracture/fracture.h"
#include "fracture/pattern/pattern.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

Compound heap(Random& random) { return split_islands(compound_of(random_boxes(random, 12)))[0]; }

/// Expects the contacts, islands, anchors and queries of a structure rebuilt from the rest.
void expect_as_rebuilt(const Structure& structure, Random& random) {
  const Compound remaining = structure.compound();
  ASSERT_EQ(remaining.convexes.size(), structure.size());
  EXPECT_EQ(remaining.bonds.size(), structure.bond_count());
  EXPECT_EQ(remaining.is_anchored(), structure.is_anchored());
  const std::vector<std::uint32_t> islands = find_islands(remaining);
  EXPECT_EQ(std::count(islands.begin(), islands.end(), 0u), std::ssize(islands));
  if (remaining.ghosts.empty()) {
    const std::vector<Bond> fresh = find_contacts(remaining.convexes);
    ASSERT_EQ(remaining.bonds.size(), fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      const Bond &x = remaining.bonds[i], &y = fresh[i];
      EXPECT_EQ(std::tie(x.a, x.b, x.face_a, x.face_b), std::tie(y.a, y.b, y.face_a, y.face_b));
      EXPECT_NEAR(x.area_m2, y.area_m2, 1e-9 * y.area_m2);
    }
  }
  const Box box = bounds(structure);
  const Vec3 at = box.center() + 0.5 * box.extent().norm() * random.direction();
  const double radius = random.uniform() * box.extent().norm();
  std::vector<ConvexSlot> near;
  structure.for_each([&](ConvexSlot slot, const Convex& convex) {
    const Vec3 gap = (convex.box.min - at).cwiseMax(at - convex.box.max).cwiseMax(0.0);
    if (gap.norm() <= radius) near.push_back(slot);
  });
  EXPECT_EQ(structure.within(at, radius), near);
}

TEST(Structure, equals_one_rebuilt_from_the_rest_after_random_breaks) {
  int edits = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    Random random(seed, 5);
    const Compound whole =
        seed % 3 == 2 ? heap(random) : grid_compound(7, 6, 5, Vec3::Ones(), true);
    const double before = volume(whole);
    Structure structure(whole);
    const Pattern pattern = voronoi_pattern(12, 2, false, seed);
    double removed_m3 = 0;
    for (std::uint64_t event = 1; event <= 8 && !structure.empty(); ++event) {
      const Box box = bounds(structure);
      const Vec3 at =
          box.min +
          Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(box.extent());
      const double radius = random.uniform(0.1, 0.4) * box.extent().maxCoeff();
      const BreakEdit edit =
          break_structure(structure, pattern, {radius * Mat3::Identity(), at}, {at, radius}, event);
      structure.apply(edit);
      edits += edit.changed ? 1 : 0;
      for (const Compound& piece : edit.loose.pieces) removed_m3 += volume(piece);
      removed_m3 += edit.loose.debris_volume_m3;
      if (structure.empty()) break;
      expect_as_rebuilt(structure, random);
      EXPECT_NEAR(volume(structure.compound()) + removed_m3, before, 1e-9 * before) << seed;
    }
  }
  EXPECT_GT(edits, 100);
}

TEST(Structure, removes_a_cut_contact_on_both_sides) {
  Structure structure(grid_compound(3, 1, 1, Vec3::Ones(), true));
  ASSERT_EQ(structure.bond_count(), 2u);
  BreakEdit edit;
  edit.cut = {structure.compound().bonds[1]};
  structure.apply(edit);
  EXPECT_EQ(structure.bond_count(), 1u);
  EXPECT_EQ(structure.links(ConvexSlot(1)).size(), 1u);
  EXPECT_TRUE(structure.links(ConvexSlot(2)).empty());
  EXPECT_EQ(structure.size(), 3u);
}

TEST(Structure, knows_the_path_of_a_ray_through_its_first_stretch) {
  // Two walls of two blocks each, 0.2 m thick and 1 m apart.
  const Structure structure(
      compound_of({Box{Vec3(-1, 0, 0), Vec3(0, 2, 0.2)}, Box{Vec3(0, 0, 0), Vec3(1, 2, 0.2)},
                   Box{Vec3(-1, 0, 1.2), Vec3(1, 2, 1.4)}}));
  const Vec3 along = Vec3(0.6, 0, 0.8);
  EXPECT_NEAR(path_through(structure, Vec3(-0.5, 1, 0), Vec3::UnitZ(), 0.1, 5), 0.2, 1e-12);
  EXPECT_NEAR(path_through(structure, Vec3(-0.1, 1, -0.05), along, 0.5, 5), 0.25, 1e-12)
      << "from before it, through both blocks";
  EXPECT_NEAR(path_through(structure, Vec3(-0.1, 1, 0.05), along, 0.5, 5), 0.25, 1e-12)
      << "from within";
  EXPECT_NEAR(path_through(structure, Vec3(-0.5, 1, 0.5), Vec3::UnitZ(), 0.5, 5), 0.2, 1e-12)
      << "from between the two walls, the second";
  EXPECT_EQ(path_through(structure, Vec3(3, 1, 0), Vec3::UnitZ(), 1, 5), 0);
}

}  // namespace
}  // namespace sunder::fracture
