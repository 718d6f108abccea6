// Tests that visual meshes of bent convexes stay closed within their convexes.
#include <gtest/gtest.h>

#include "engine/geometry/polygon_mesh.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/rejoin.h"
#include "tests/engine/geometry_fixtures.h"
#include "tests/fracture/bent_beam.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/visual_truths.h"

namespace sunder::fracture {
namespace {

/// Returns a round bar along x with a visual mesh, in pieces that a break made.
Compound round_bar(std::uint64_t seed) {
  PolygonMesh mesh = polygon_mesh(make_prism(test::regular_polygon(12, 0.2), -1, 1, false));
  for (Vec3& v : mesh.vertices) v = Vec3(v.y(), v.x(), -v.z());
  for (PolygonMesh::Face& face : mesh.faces) {
    face.plane.normal = Vec3(face.plane.normal.y(), face.plane.normal.x(), -face.plane.normal.z());
    face.id = {}, face.kind = FaceKind::kSurface;
  }
  BreakCommand command;
  command.event = command.seed = seed;
  command.pattern.kind = PatternSpec::Kind::kSlabs;
  command.pattern.cells = 6;
  command.radius_m = 100;
  const BreakPlan plan = break_compound(solid_of(std::move(mesh)), command);
  Compound all;
  for (const Compound& piece : plan.pieces)
    all.convexes.insert(all.convexes.end(), piece.convexes.begin(), piece.convexes.end());
  all.anchored.assign(all.convexes.size(), 0);
  all.bonds = find_contacts(all.convexes);
  return all;
}

void expect_watertight_where_it_bends(const Compound& whole, const Plane& plane, double angle) {
  const Halves halves = split_at_plane(whole, plane);
  ASSERT_FALSE(halves.section.slots_a.empty());
  const Quat bend(Eigen::AngleAxisd(angle, plane.normal.unitOrthogonal()));
  const Bent bent(halves, rotate_about_section(halves.section, bend), 100);
  const Rejoined result = rejoin_bent(bent.pair);
  ASSERT_TRUE(result.edit.changed);
  Structure structure = bent.a;
  structure.apply(result.edit);
  const Compound one = structure.compound();
  for (const ConvexPtr& part : one.convexes) {
    EXPECT_TRUE(is_closed(part->polyhedron));
    ASSERT_FALSE(part->is_internal());
    EXPECT_EQ(open_edges(*part->visual), 0u);
    EXPECT_GT(mass_properties(*part->visual).volume_m3, 0);
  }
  EXPECT_EQ(split_islands(one).size(), 1u);
  EXPECT_NEAR(volume(one), volume(whole), 1e-12);
}

TEST(Rejoin, VisualMeshesStayWatertight) {
  int tried = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Compound whole = round_bar(seed);
    for (const Bond& bond : whole.bonds) {
      const Convex& convex = *whole.convexes[bond.a];
      for (const double angle : {1e-6, 0.1, 0.5, 1.5}) {
        SCOPED_TRACE(angle);
        const Plane& plane = convex.polyhedron.faces[bond.face_a].plane;
        expect_watertight_where_it_bends(whole, plane, angle);
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 30);
}

}  // namespace
}  // namespace sunder::fracture
