// Tests of decompositions of real and made meshes: pieces are watertight and make up the whole,
// hulls enclose the meshes of their pieces, and regions share planes.
#include "fracture/vacd/vacd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/repair/winding.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/vacd/nodes.h"
#include "tests/mesh/mesh_files.h"

namespace sunder::fracture {
namespace {

RepairedMesh one_shell(PolygonMesh mesh) {
  RepairedMesh repaired;
  repaired.shells.push_back(std::move(mesh));
  repaired.closed = true;
  return repaired;
}

RepairedMesh cube() { return one_shell(polygon_mesh(make_box(Vec3::Zero(), Vec3::Ones()))); }

/// Returns "" if the convexes are as decompose() promises; otherwise the first violation.
std::string find_violation(const Compound& compound, const RepairedMesh& mesh) {
  double whole = 0, boxes_m3 = 0;
  for (const PolygonMesh& shell : mesh.shells) {
    whole += mass_properties(shell).volume_m3;
    boxes_m3 += bounds(shell).extent().prod();
  }
  double sum = 0;
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    const Convex& convex = *compound.convexes[c];
    const std::string which = " of convex " + std::to_string(c);
    sum += convex.solid.volume_m3;
    if (!(convex.solid.volume_m3 > 0)) return "no volume" + which;
    if (!is_closed(convex.polyhedron)) return "open polyhedron" + which;
    const PolygonMesh visual = convex.visual ? *convex.visual : polygon_mesh(convex.polyhedron);
    if (open_edges(visual) != 0) return "open mesh" + which;
    const double size = bounds(convex.polyhedron).extent().maxCoeff();
    for (const ConvexPolyhedron::Face& face : convex.polyhedron.faces) {
      if (face.id.none()) return "plane without an id" + which;
      for (const Vec3& v : visual.vertices) {
        if (face.plane.distance(v) > 1e-10 * size) return "mesh outside the hull" + which;
      }
    }
  }
  // The tolerance is relative to the box where the volume is a small difference of large parts.
  if (std::abs(sum - whole) > 1e-12 * std::max(whole, boxes_m3)) {
    return "volumes sum to " + std::to_string(sum) + " of " + std::to_string(whole);
  }
  return "";
}

std::vector<std::array<Vec3, 3>> triangles(const PolygonMesh& mesh) {
  std::vector<std::array<Vec3, 3>> fans;
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    for (std::size_t i = 2; i < corners.size(); ++i) {
      fans.push_back(
          {mesh.vertices[corners[0]], mesh.vertices[corners[i - 1]], mesh.vertices[corners[i]]});
    }
  }
  return fans;
}

/// Expects the winding number of the mesh at random points: pieces cover it without overlap.
void expect_same_winding(const Compound& compound, const PolygonMesh& mesh) {
  const WindingField whole(triangles(mesh));
  std::vector<WindingField> parts;
  for (const ConvexPtr& convex : compound.convexes) {
    parts.emplace_back(
        triangles(convex->visual ? *convex->visual : polygon_mesh(convex->polyhedron)));
  }
  const Box box = bounds(mesh);
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Vec3 share(random.uniform(), random.uniform(), random.uniform());
    const Vec3 point = box.min + share.cwiseProduct(box.extent());
    double sum = 0;
    for (const WindingField& part : parts) sum += part.at(point);
    EXPECT_NEAR(sum, whole.at(point), 0.25);
  }
}

TEST(Vacd, OfRealMeshesKeepsItsInvariants) {
  for (const std::string set : {"good", "nasty"}) {
    for (const auto& file : test::meshes(set)) {
      const std::string name = file.filename().string();
      RepairedMesh mesh;
      try {
        mesh = repair_mesh(read_mesh(file), name);
      } catch (const InputError&) {
        EXPECT_EQ(set, "nasty") << name;
        continue;
      }
      const Vacd vacd = decompose(mesh);
      EXPECT_LE(vacd.figures.inside_out_m3, 1e-3 * vacd.figures.shell_volume_m3) << name;
      EXPECT_EQ(find_violation(vacd.compound, mesh), "") << name;
      if (vacd.figures.max_faces_per_convex > 3000) continue;  // Would take too long.
      VacdOptions tight;
      tight.convexes = 8;
      const Compound compound = decompose(mesh, tight).compound;
      EXPECT_EQ(find_violation(compound, mesh), "") << name;
      EXPECT_LE(compound.convexes.size(), std::max<std::size_t>(8, mesh.shells.size())) << name;
    }
  }
}

/// Returns an L of two boxes, as one mesh of 12 vertices; two convexes make it up exactly.
RepairedMesh corner_mesh() {
  const Vec2 outline[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
  RawMesh raw;
  for (const double z : {0.0, 1.0}) {
    for (const Vec2& p : outline) raw.vertices.emplace_back(p.x(), p.y(), z);
  }
  const auto add = [&](std::vector<std::uint32_t> corners) {
    raw.polygons.push_back({static_cast<std::uint32_t>(raw.corners.size()),
                            static_cast<std::uint32_t>(corners.size()), 0});
    raw.corners.insert(raw.corners.end(), corners.begin(), corners.end());
  };
  add({5, 4, 3, 2, 1, 0});
  add({6, 7, 8, 9, 10, 11});
  for (std::uint32_t i = 0; i < 6; ++i) add({i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i});
  return repair_mesh(std::move(raw), "corner");
}

TEST(Vacd, CutsWhereAMeshIsConcave) {
  VacdOptions options;
  options.convexes = 2;
  const RepairedMesh mesh = corner_mesh();
  const Vacd vacd = decompose(mesh, options);
  EXPECT_EQ(vacd.compound.convexes.size(), 2u);
  EXPECT_LT(vacd.figures.hull_volume_ratio(), 1.02);
  EXPECT_EQ(find_violation(vacd.compound, mesh), "");
}

TEST(Vacd, IsTheSameForAnyNumberOfThreads) {
  VacdOptions options;
  options.node_count = 3;
  options.convexes = 7;
  const RepairedMesh mesh = corner_mesh();
  set_threads(1);
  const Compound one = decompose(mesh, options).compound;
  for (const int count : {2, 5}) {
    set_threads(count);
    const Compound many = decompose(mesh, options).compound;
    ASSERT_EQ(many.convexes.size(), one.convexes.size());
    for (std::size_t c = 0; c < one.convexes.size(); ++c) {
      const Convex &a = *one.convexes[c], &b = *many.convexes[c];
      EXPECT_EQ(a.polyhedron.vertices, b.polyhedron.vertices);
      ASSERT_EQ(a.is_internal(), b.is_internal());
      if (!a.is_internal()) {
        EXPECT_EQ(a.visual->vertices, b.visual->vertices);
      }
    }
    ASSERT_EQ(many.bonds.size(), one.bonds.size());
  }
  set_threads(0);
}

TEST(Vacd, PiecesCoverTheMeshWithoutOverlap) {
  for (const std::string name : {"frame", "pebble", "ring", "star"}) {
    const RepairedMesh mesh = repair_mesh(test::make_good(name), name);
    VacdOptions options;
    options.convexes = 10;
    expect_same_winding(decompose(mesh, options).compound, mesh.shells[0]);
    expect_same_winding(decompose(mesh).compound, mesh.shells[0]);
  }
}

/// Returns a tube about the y axis, of height 1 and outer radius 0.5.
RepairedMesh tube(double inner_radius, std::uint32_t sides) {
  RawMesh raw;
  for (const double y : {0., 1.}) {
    for (const double radius : {0.5, inner_radius}) {
      for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * 3.14159265358979 * i / sides;
        raw.vertices.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
      }
    }
  }
  const std::uint32_t inner = sides, top = 2 * sides;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    test::add(raw, {i, top + i, top + j, j});
    test::add(raw, {inner + j, top + inner + j, top + inner + i, inner + i});
    test::add(raw, {inner + i, i, j, inner + j});
    test::add(raw, {top + i, top + inner + i, top + inner + j, top + j});
  }
  return repair_mesh(std::move(raw), "tube");
}

TEST(Vacd, ByDefaultATubeStaysOpen) {
  for (const double inner_radius : {0.2, 0.35, 0.45, 0.47}) {
    for (const std::uint32_t sides : {16u, 60u}) {
      const RepairedMesh mesh = tube(inner_radius, sides);
      const Vacd vacd = decompose(mesh);
      EXPECT_EQ(find_violation(vacd.compound, mesh), "") << inner_radius;
      EXPECT_TRUE(vacd.figures.has_tight_hulls()) << inner_radius;
      for (const ConvexPtr& convex : vacd.compound.convexes) {
        for (const double y : {0.02, 0.3, 0.5, 0.7, 0.98})
          EXPECT_GT(distance_to(*convex, Vec3(0, y, 0)), 0.45 * inner_radius) << inner_radius;
      }
    }
  }
}

TEST(Vacd, ByDefaultHasHullsThatAreTightOrThatTwiceAsManyNodesHardlyImprove) {
  for (const std::string& name : test::good_names()) {
    const RepairedMesh mesh = repair_mesh(test::make_good(name), name);
    const Vacd vacd = decompose(mesh);
    if (vacd.figures.has_tight_hulls()) continue;
    VacdOptions more;
    more.node_count = static_cast<std::uint32_t>(2 * vacd.compound.convexes.size());
    EXPECT_GT(decompose(mesh, more).figures.hull_volume_ratio() - 1,
              0.8 * (vacd.figures.hull_volume_ratio() - 1))
        << name << ": " << vacd.compound.convexes.size() << " convexes";
  }
}

TEST(Vacd, NeverMakesAPieceOfMorePolygonsThanAllowed) {
  const RepairedMesh mesh = repair_mesh(test::make_good("knot"), "knot");
  VacdOptions options;
  options.node_count = 2;
  options.polygons = 500;
  const Vacd vacd = decompose(mesh, options);
  EXPECT_LE(vacd.figures.max_faces_per_convex, 500u);
  EXPECT_EQ(find_violation(vacd.compound, mesh), "");
}

TEST(Vacd, ShellsThatOverlapAreHeldTogetherByGhosts) {
  RepairedMesh mesh;
  mesh.shells.push_back(polygon_mesh(make_box(Vec3(0, 0, 0), Vec3(1, 4, 1))));
  mesh.shells.push_back(polygon_mesh(make_box(Vec3(-1, 3, -1), Vec3(2, 5, 2))));
  VacdOptions options;
  options.convexes = 2;
  const Vacd vacd = decompose(mesh, options);
  EXPECT_EQ(vacd.compound.convexes.size(), 2u);
  EXPECT_EQ(vacd.figures.ghosts, 1u);
  EXPECT_EQ(find_violation(vacd.compound, mesh), "");
}

TEST(Vacd, RefusesMoreNodesByHandThanConvexesAllowed) {
  VacdOptions options;
  options.nodes = {Vec3(0.2, 0.5, 0.5), Vec3(0.5, 0.5, 0.5), Vec3(0.8, 0.5, 0.5)};
  options.convexes = 2;
  EXPECT_THROW(decompose(cube(), options), InputError);
  options.convexes = 3;
  EXPECT_EQ(decompose(cube(), options).compound.convexes.size(), 3u);
}

/// Returns a grid of 3 × 3 × 3 nodes in a unit cube.
VacdOptions grid_nodes() {
  VacdOptions options;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 3; ++z) options.nodes.push_back((Vec3(x, y, z) + Vec3::Ones()) / 4);
    }
  }
  return options;
}

TEST(Vacd, CellsWithinTheMeshAreInternal) {
  RepairedMesh mesh = cube();
  mesh.shells[0].corner_uvs.assign(mesh.shells[0].corners.size(), Vec2f(0.5f, 0.5f));
  const Vacd vacd = decompose(mesh, grid_nodes());
  ASSERT_EQ(vacd.compound.convexes.size(), 27u);
  EXPECT_EQ(find_violation(vacd.compound, mesh), "");
  EXPECT_EQ(std::count_if(vacd.compound.convexes.begin(), vacd.compound.convexes.end(),
                          [](const ConvexPtr& convex) { return convex->is_internal(); }),
            1);
  EXPECT_EQ(vacd.compound.bonds.size(), 54u);  // Between neighbours in a 3 × 3 × 3 grid.
}

TEST(Vacd, TwoNodesOfABarLieAtTheMeansOfTheSurfaceOfItsHalves) {
  const PolygonMesh bar = polygon_mesh(make_box(Vec3::Zero(), Vec3(10, 1, 1)));
  std::vector<Vec3> nodes = automatic_nodes(bar, 2);
  ASSERT_EQ(nodes.size(), 2u);
  if (nodes[0].x() > nodes[1].x()) std::swap(nodes[0], nodes[1]);
  const double mean_m = 2.5 * 20 / 21;  // The mean of four sides of 5 m² and one end of 1 m² at 0.
  EXPECT_LT((nodes[0] - Vec3(mean_m, 0.5, 0.5)).norm(), 0.2) << "as far as samples allow";
  EXPECT_LT((nodes[1] - Vec3(10 - mean_m, 0.5, 0.5)).norm(), 0.2);
}

TEST(Vacd, FlatConvexPiecesNeedNoVisualMesh) {
  const Vacd vacd = decompose(cube(), grid_nodes());
  EXPECT_EQ(find_violation(vacd.compound, cube()), "");
  std::size_t surface_faces = 0;
  for (const ConvexPtr& convex : vacd.compound.convexes) {
    EXPECT_TRUE(convex->is_internal());
    for (const ConvexPolyhedron::Face& face : convex->polyhedron.faces) {
      surface_faces += face.kind == FaceKind::kSurface;
    }
  }
  EXPECT_EQ(surface_faces, 54u);  // Nine on each side of the cube.
}

TEST(Vacd, ConvexPiecesThatAreShadedSmoothKeepTheirVisualMeshes) {
  RepairedMesh mesh = cube();
  PolygonMesh& shell = mesh.shells[0];
  for (std::size_t c = 0; c < shell.corners.size(); ++c) {
    const Vec3 out = shell.vertices[shell.corners[c]] - Vec3::Constant(0.5);
    shell.corner_normals[c] = out.normalized().cast<float>();
  }
  const Vacd vacd = decompose(mesh, grid_nodes());
  EXPECT_EQ(std::count_if(vacd.compound.convexes.begin(), vacd.compound.convexes.end(),
                          [](const ConvexPtr& convex) { return convex->is_internal(); }),
            1);
}

TEST(Vacd, NodesComeFromAFileAndErrorsNameTheLine) {
  std::istringstream good("# a row\n0 0 0\n\n1.5 -2 3e-1 # last\n");
  EXPECT_EQ(read_nodes(good, "row.txt"), (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1.5, -2, 0.3)}));
  for (const std::string bad :
       {"0 0 0\n1 2\n", "0 0 0\n1 2 3 4\n", "0 0 0\n1 2 nan\n", "0 0 0\nx\n"}) {
    std::istringstream in(bad);
    try {
      read_nodes(in, "row.txt");
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("row.txt:2: ", 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace sunder::fracture
