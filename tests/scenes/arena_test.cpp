// Tests of arenas: curved visual meshes in convexes that fit together.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/geometry/polygon_mesh.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/adjacency/islands.h"
#include "scenes/file/moved_part.h"
#include "scenes/load.h"
#include "scenes/structures/loft.h"

namespace sunder::scenes {
namespace {

Scene arena(const std::string& lines) {
  return parse_scene("[scene]\ndescription = \"x\"\n[[solid]]\nstructure = \"arena\"\n" + lines,
                     "x.toml", {});
}

constexpr char kSmall[] = "ends = 4\nsides = 3\ntiers = 5\ndetail = 12";

std::string message_of(const std::string& lines) {
  try {
    arena(lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Loft, AnythingTurnedHasTheVolumeOfItsProfile) {
  // Two frusta of regular polygons, 24 sides.
  const std::vector<Vec2> profile = {{1, 0}, {2, 1}, {0.5, 3}};
  const PolygonMesh mesh = loft(turned(circle(24), profile));
  const double sides = 12 * std::sin(2 * std::numbers::pi / 24);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_NEAR(mass_properties(mesh).volume_m3,
              sides * (1 * (1 + 2 + 4) / 3.0 + 2 * (4 + 1 + 0.25) / 3.0), 1e-12);
}

TEST(Loft, RoundSurfacesAreShadedSmoothlyAndEdgesStaySharp) {
  const std::vector<Vec2> profile = {{1, 0}, {1, 2}};
  const PolygonMesh mesh = loft(turned(circle(24), profile));
  ASSERT_EQ(mesh.faces.size(), 26u);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::uint32_t c = mesh.contours[f].first_corner, n = 0; n < mesh.contours[f].corner_count;
         ++n, ++c) {
      const Vec3 normal = mesh.corner_normals[c].cast<double>();
      const Vec3& at = mesh.vertices[mesh.corners[c]];
      const bool end = std::abs(mesh.faces[f].plane.normal.y()) > 0.5;
      const Vec3 expected = end ? mesh.faces[f].plane.normal : Vec3(at.x(), 0, at.z());
      EXPECT_LT((normal - expected).norm(), 1e-6);
    }
  }
}

TEST(Loft, QuadranglesThatAreNotFlatAreHalved) {
  const std::vector<Ring> twisted = {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}},
                                     {{0, 1, 0.3}, {1, 1, 0}, {1, 1.2, 1}, {0, 1, 1}}};
  const PolygonMesh mesh = loft(twisted);
  EXPECT_EQ(open_edges(mesh), 0u);
  for (std::size_t f = 2; f < mesh.faces.size(); ++f) {
    for (const std::uint32_t v : mesh.contour_corners(f))
      EXPECT_NEAR(mesh.faces[f].plane.distance(mesh.vertices[v]), 0, 1e-9);
  }
}

TEST(Arena, HasAMillionVerticesOnMeshesThatAreCurved) {
  const Scene scene = arena("");
  std::size_t vertices = 0, faces = 0;
  for (const Solid& solid : scene.solids) {
    for (const ConvexPtr& convex : solid.compound.convexes) {
      if (convex->is_internal()) continue;
      vertices += convex->visual->vertices.size();
      faces += convex->visual->faces.size();
    }
  }
  EXPECT_GE(vertices, 1000000u);
  EXPECT_GE(faces, 500000u);
}

/// Returns the number of edges between two faces in one plane.
std::size_t needless_faces(const PolygonMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> face_of;
  const auto each_edge = [&](auto visit) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const PolygonMesh::Face& face = mesh.faces[f];
      for (std::uint32_t k = 0; k < face.contour_count; ++k) {
        const auto corners = mesh.contour_corners(face.first_contour + k);
        for (std::size_t i = 0; i < corners.size(); ++i)
          visit(f, corners[i], corners[(i + 1) % corners.size()]);
      }
    }
  };
  each_edge([&](std::size_t f, std::uint32_t a, std::uint32_t b) { face_of[{a, b}] = f; });
  std::size_t needless = 0;
  each_edge([&](std::size_t f, std::uint32_t a, std::uint32_t b) {
    const auto other = face_of.find({b, a});
    if (other == face_of.end() || other->second <= f) return;
    needless += mesh.faces[f].plane.normal.dot(mesh.faces[other->second].plane.normal) > 1 - 1e-9;
  });
  return needless;
}

// Exceptions are the flat bands of archivolts, which are divided where their edges bend.
TEST(Arena, SplitsNoFlatFace) {
  const Scene scene = arena("");
  std::size_t faces = 0, needless = 0;
  for (const ConvexPtr& convex : scene.solids[0].compound.convexes) {
    if (convex->is_internal()) continue;
    faces += convex->visual->faces.size();
    needless += needless_faces(*convex->visual);
  }
  EXPECT_LE(60 * needless, faces) << needless << " of " << faces;
}

TEST(Arena, ItsMeshesAreWatertightAndWithinTheirConvexes) {
  for (const Solid& solid : arena(kSmall).solids) {
    for (const ConvexPtr& convex : solid.compound.convexes) {
      ASSERT_TRUE(is_closed(convex->polyhedron));
      if (convex->is_internal()) continue;
      ASSERT_EQ(open_edges(*convex->visual), 0u);
      for (const Vec3& vertex : convex->visual->vertices)
        ASSERT_LT(distance_to(*convex, vertex), 1e-9);
      const double outer_m3 = mass_properties(convex->polyhedron).volume_m3;
      EXPECT_GT(convex->solid.volume_m3, 0.25 * outer_m3);
    }
  }
}

TEST(Arena, IsArcadesAndSeatsInWedgesThatStandOnTheGround) {
  const Scene scene = arena("");
  ASSERT_EQ(scene.solids.size(), 2u * 2 * (8 + 6) + 1);
  for (const Solid& solid : scene.solids) {
    const std::vector<std::uint32_t> island = fracture::find_islands(solid.compound);
    EXPECT_EQ(*std::max_element(island.begin(), island.end()), 0u);
    EXPECT_TRUE(solid.compound.is_anchored());
    EXPECT_TRUE(solid.compound.ghosts.empty());
    EXPECT_NEAR(bounds(solid.compound).min.y(), 0, 1e-9);
  }
}

TEST(Arena, WedgesOfAKindShareTheirConvexes) {
  const Scene scene = arena(kSmall);
  std::map<const Convex*, int> uses;
  for (const Solid& solid : scene.solids) ++uses[solid.compound.convexes[0].get()];
  std::vector<int> counts;
  for (const auto& [convex, count] : uses) counts.push_back(count);
  std::ranges::sort(counts);
  EXPECT_EQ(counts, (std::vector<int>{6, 6, 8, 8})) << "arcades and seats of sides and of ends";
}

TEST(Arena, WedgesMeetAndDoNotOverlap) {
  std::vector<Part> parts;
  double volume_m3 = 0;
  for (const Solid& solid : arena(kSmall).solids) {
    volume_m3 += volume(solid.compound);
    for (Part& part : parts_of(solid.compound)) parts.push_back(moved(std::move(part), solid.X_WR));
  }
  const Compound whole = fracture::make_compound(std::move(parts));
  EXPECT_TRUE(whole.ghosts.empty());
  EXPECT_NEAR(volume(whole), volume_m3, 1e-9 * volume_m3);
  const std::vector<std::uint32_t> island = fracture::find_islands(whole);
  EXPECT_EQ(*std::max_element(island.begin(), island.end()), 1u) << "arcades, and seats";
}

TEST(Arena, AnImpossibleArenaIsRefused) {
  EXPECT_NE(message_of("tiers = 16").find("reach up to 11 m, above the gallery"), std::string::npos)
      << message_of("tiers = 16");
  EXPECT_NE(message_of("ends = 13").find("up to twice the sides"), std::string::npos);
  EXPECT_NE(message_of("storey_m = 3.2").find("too low for arches"), std::string::npos);
  EXPECT_NE(message_of("ends = 4\nsides = 3").find("from the middle of an end to the podium"),
            std::string::npos);
}

}  // namespace
}  // namespace sunder::scenes
