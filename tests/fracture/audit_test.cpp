// Tests that the audit finds defects of pieces, and measures overlaps exactly.
#include "fracture/check/audit.h"

#include <gtest/gtest.h>

#include "engine/geometry/clip_mesh.h"
#include "fracture/solids.h"

namespace sunder::fracture {
namespace {

Compound box(const Vec3& min, const Vec3& max) { return box_compound(min, max); }

/// Returns a box whose visual mesh is the part of the box with x + y < `below`.
Compound wedge(const Vec3& min, const Vec3& max, double below) {
  const ConvexPolyhedron shape = make_box(min, max);
  auto visual = std::make_shared<PolygonMesh>();
  MeshClipScratch scratch;
  const Plane plane{Vec3(1, 1, 0).normalized(), -below / std::sqrt(2)};
  EXPECT_EQ(clip(polygon_mesh(shape), plane, PlaneId{2}, 1e-14, *visual, scratch), PlaneSide::kCut);
  return {{make_convex(shape, MaterialIndex(0u), visual)}, {0}, {}, {}};
}

TEST(Audit, PiecesThatOnlyTouchDoNotOverlap) {
  const Compound pieces[] = {box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})};
  const Audit found = audit(pieces);
  EXPECT_EQ(found.pieces, 2u);
  EXPECT_EQ(found.watertight_pieces, 2u);
  EXPECT_EQ(found.islands, 2u);
  EXPECT_EQ(found.overlap_m3, 0);
  EXPECT_TRUE(found.overlap_is_exact);
  EXPECT_DOUBLE_EQ(found.volume_m3, 2);
}

TEST(Audit, AnOverlapIsMeasuredExactly) {
  const Compound pieces[] = {box({0, 0, 0}, {1, 1, 1}), box({.5, .25, -1}, {2, 2, .5})};
  EXPECT_NEAR(audit(pieces).overlap_m3, .5 * .75 * .5, 1e-15);
}

TEST(Audit, OverlapsAreThoseOfVisualMeshesAndNotOfTheirHulls) {
  // The hulls share the whole unit box; the meshes share a part of it.
  const Compound low = wedge({0, 0, 0}, {1, 1, 1}, 0.5);
  const Compound whole = box({0, 0, 0}, {1, 1, 1});
  bool exact = true;
  EXPECT_NEAR(common_volume(*low.convexes[0], *whole.convexes[0], exact), 0.125, 1e-14);
  const Compound moved = wedge({.25, 0, 0}, {1.25, 1, 1}, 1);
  // x + y < 0.5 and x > 0.25 is a triangle of legs 0.25.
  EXPECT_NEAR(common_volume(*low.convexes[0], *moved.convexes[0], exact), 0.03125, 1e-14);
  EXPECT_TRUE(exact);
}

TEST(Audit, FindsAnOpenSurfaceAndAPieceInTwoParts) {
  Compound piece = box({0, 0, 0}, {1, 1, 1});
  const Compound far = box({5, 0, 0}, {6, 1, 1});
  piece.convexes.push_back(far.convexes[0]);
  piece.anchored.push_back(0);
  auto open = std::make_shared<PolygonMesh>(polygon_mesh(piece.convexes[0]->polyhedron));
  open->faces.pop_back();
  open->contours.pop_back();
  open->corners.resize(open->corners.size() - 4);
  open->corner_normals.resize(open->corners.size());
  piece.convexes[0] =
      make_convex(piece.convexes[0]->polyhedron, piece.convexes[0]->material, std::move(open));
  const Audit found = audit(std::span(&piece, 1));
  EXPECT_EQ(found.islands, 2u);
  EXPECT_EQ(found.watertight_pieces, 0u);
  EXPECT_EQ(found.surface.open_edges, 4u);
}

}  // namespace
}  // namespace sunder::fracture
