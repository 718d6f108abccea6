// Symptom: thin pieces of glass made the bodies that they touched not finite, so that these were
// frozen. Cause: the closest points of two edges were found by division by the length of an edge
// whose ends round to one point. Fixed in 63876fb.
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/convex_polyhedron.h"
#include "solver/rigid/collide/patch.h"

namespace sunder::solver {
namespace {

TEST(RegressSliver, EdgesOfZeroLengthHaveAFiniteContactPoint) {
  const double thin_m = 1e-8;
  const Hull block(make_box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), Vec3::Zero());
  const Hull pane(make_box(Vec3(-1, -thin_m, -1), Vec3(1, thin_m, 1)), Vec3::Zero());
  RelativePose pose;
  pose.R.setIdentity();
  pose.p = Vec3f(0, 1, 0);
  HullScratch hulls;
  place_in_A(pane, pose, hulls);
  PatchScratch scratch;
  int short_edges = 0;
  for (std::uint32_t e = 0; e < pane.edge_count(); ++e) {
    const auto [from, to] = pane.edge_vertices(e);
    if (hulls.vertex_b(from) != hulls.vertex_b(to)) continue;
    ++short_edges;
    const SeparatingAxis axis = {SeparatingAxis::Kind::kEdges, Vec3f::UnitY(), 0, 0, e};
    std::vector<PatchPoint> points;
    make_patch(block, pane, pose, axis, 1, hulls, scratch, points);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_TRUE(points[0].on_a.allFinite());
    EXPECT_EQ(points[0].on_b, hulls.vertex_b(from));
  }
  EXPECT_EQ(short_edges, 4);
}

}  // namespace
}  // namespace sunder::solver
