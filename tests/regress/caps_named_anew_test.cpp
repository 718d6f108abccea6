// Symptom: the convexes of a decomposed mesh fell apart at the first impact, even far from it.
// Cause: when a compound gave its planes new ids, the caps of visual meshes kept the old ones, so
// that no two caps touched and there was no bond. Fixed in 827e1ab.
#include <gtest/gtest.h>

#include "fracture/vacd/vacd.h"
#include "tests/engine/geometry_mesh_fixtures.h"

namespace sunder::fracture {
namespace {

TEST(RegressCaps, EachConvexOfADecomposedRingHasTwoBonds) {
  PolygonMesh ring = test::torus(24, 10);
  for (PolygonMesh::Face& face : ring.faces) face.id = {}, face.kind = FaceKind::kSurface;
  RepairedMesh mesh;
  mesh.shells.push_back(ring);
  mesh.closed = true;
  VacdOptions options;
  options.node_count = 6;
  const Compound compound = decompose(mesh, options).compound;
  ASSERT_GE(compound.convexes.size(), 6u);
  std::vector<int> bonds_of(compound.convexes.size());
  for (const auto& bond : compound.bonds) ++bonds_of[bond.a], ++bonds_of[bond.b];
  for (const int bonds : bonds_of) EXPECT_GE(bonds, 2);
}

}  // namespace
}  // namespace sunder::fracture
