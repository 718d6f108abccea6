// Tests of repair: defects are repaired and reported, valid meshes unchanged, time is bounded.
#include "engine/geometry/repair/repair.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/inside_out.h"
#include "engine/geometry/repair/winding.h"
#include "engine/geometry/triangulate.h"
#include "engine/io/mesh/mesh_reader.h"
#include "tests/cpu_time.h"
#include "tests/mesh/mesh_files.h"

namespace sunder {
namespace {

/// Factor on time limits for sanitizers, checked libraries and processors that may be emulated.
#if defined(NDEBUG) && !defined(__aarch64__)
constexpr double kTimeFactor = 1;
#else
constexpr double kTimeFactor = 20;
#endif

/// Appends a box of six quads; some of its faces (-x +x -y +y -z +z) may be omitted.
void add_box(RawMesh& mesh, const Vec3& min, const Vec3& max, std::set<int> without = {},
             bool inside_out = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(),
                               i & 4 ? max.z() : min.z());
  }
  constexpr std::uint32_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (int f = 0; f < 6; ++f) {
    if (without.contains(f)) continue;
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t v : kFaces[f]) corners.push_back(first + v);
    if (inside_out) std::reverse(corners.begin(), corners.end());
    append_polygon(mesh, corners, 0);
  }
}

RawMesh box(std::set<int> without = {}) {
  RawMesh mesh;
  add_box(mesh, Vec3::Zero(), Vec3(1, 2, 3), std::move(without));
  return mesh;
}

double total_volume(const RepairedMesh& repaired) {
  double sum = 0;
  for (const PolygonMesh& shell : repaired.shells) {
    EXPECT_EQ(open_edges(shell), 0u);
    EXPECT_GT(mass_properties(shell).volume_m3, 0);
    sum += mass_properties(shell).volume_m3;
  }
  return sum;
}

std::size_t count_of(const RepairedMesh& repaired, const std::string& name) {
  std::size_t count = 0;
  for (const Repair& repair : repaired.repairs) {
    if (repair.name == name) count += repair.count;
  }
  return count;
}

TEST(InsertInEdges, InterpolatesTheAttributesOfNewCorners) {
  RawMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {3, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int copy = 0; copy < 2; ++copy) append_polygon(mesh, std::vector{0u, 1u, 2u, 3u}, 0);
  const auto uv_at = [](const Vec3& at) -> Vec2f {
    return Vec2(at.x() / 4, at.y() / 8).cast<float>();
  };
  for (const std::uint32_t v : mesh.corners) {
    mesh.corner_uvs.emplace_back(uv_at(mesh.vertices[v]));
    mesh.corner_normals.emplace_back(static_cast<float>(mesh.vertices[v].x()), 0.0f, 1.0f);
  }
  insert_in_edges(mesh, {{4, 1, 5}, {4, 3, 4}, {7, 3, 6}});
  ASSERT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 5, 4, 1, 2, 3, 6}));
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    const Vec3& at = mesh.vertices[mesh.corners[c]];
    EXPECT_EQ(mesh.corner_uvs[c], uv_at(at)) << at.transpose();
    EXPECT_EQ(mesh.corner_normals[c].x(), static_cast<float>(at.x())) << at.transpose();
  }
}

TEST(Repair, AValidMeshIsUnchanged) {
  const RepairedMesh repaired = repair_mesh(box(), "box", {.repair = false});
  EXPECT_TRUE(repaired.closed);
  EXPECT_TRUE(repaired.repairs.empty());
  ASSERT_EQ(repaired.shells.size(), 1u);
  EXPECT_EQ(repaired.shells[0].faces.size(), 6u);
  EXPECT_EQ(total_volume(repaired), 6);
  for (std::size_t c = 0; c < 24; ++c) {  // The edges of a box are creases.
    EXPECT_EQ(repaired.shells[0].corner_normals[c].cwiseAbs().sum(), 1);
  }
}

TEST(Repair, AHoleIsClosedByOnePolygon) {
  const RepairedMesh repaired = repair_mesh(box({2}), "box");
  EXPECT_FALSE(repaired.closed);
  EXPECT_EQ(count_of(repaired, "planar holes closed"), 1u);
  EXPECT_EQ(repaired.shells[0].faces.size(), 6u);
  EXPECT_EQ(total_volume(repaired), 6);
}

TEST(Repair, AMeshWithDefectsIsRefusedIfRepairIsOff) {
  try {
    repair_mesh(box({2}), "box.obj", {.repair = false});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "box.obj: the mesh needs repairs, but repair is off: planar holes closed (1); fix "
                 "the mesh, or set repair to auto");
  }
}

TEST(Repair, SeparateFacesAreJoined) {
  RawMesh apart;
  const RawMesh whole = box();
  Random random(1);
  for (std::size_t p = 0; p < whole.polygons.size(); ++p) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t v : whole.polygon_corners(p)) {
      corners.push_back(static_cast<std::uint32_t>(apart.vertices.size()));
      apart.vertices.push_back(whole.vertices[v] + 1e-7 * random.direction());
    }
    append_polygon(apart, corners, 0);
  }
  const RepairedMesh repaired = repair_mesh(apart, "box");
  EXPECT_EQ(count_of(repaired, "close vertices joined"), 16u);
  EXPECT_EQ(repaired.shells.size(), 1u);
  EXPECT_NEAR(total_volume(repaired), 6, 1e-5);
}

TEST(Repair, TwinVerticesThatNoEdgeJoinsAreJoined) {
  RawMesh twice = box();
  RawMesh moved = box();
  for (Vec3& vertex : moved.vertices) vertex += Vec3::Constant(1e-8);
  test::append(twice, moved);
  const RepairedMesh repaired = repair_mesh(twice, "box");
  EXPECT_EQ(count_of(repaired, "twin vertices joined"), 8u);
  EXPECT_EQ(repaired.shells.size(), 1u);
  EXPECT_NEAR(total_volume(repaired), 6, 1e-7);
  // Short edges stay.
  const RawMesh thin = test::make_block(Vec3::Zero(), Vec3(1, 1, 1e-8), false);
  EXPECT_EQ(count_of(repair_mesh(thin, "plate"), "twin vertices joined"), 0u);
}

TEST(Repair, FacesAreOrientedConsistentlyAndOutward) {
  RawMesh mesh = box();
  reverse_polygon(mesh, 0);
  reverse_polygon(mesh, 3);
  const RepairedMesh repaired = repair_mesh(mesh, "box");
  EXPECT_EQ(count_of(repaired, "faces flipped to match their neighbours"), 2u);
  EXPECT_EQ(total_volume(repaired), 6);
  RawMesh inside_out;
  add_box(inside_out, Vec3::Zero(), Vec3(1, 2, 3), {}, true);
  EXPECT_EQ(total_volume(repair_mesh(inside_out, "box")), 6);
}

TEST(Repair, DegenerateAndDuplicateFacesAreDropped) {
  RawMesh mesh = box();
  append_polygon(mesh, std::array{0u, 0u, 1u}, 0);
  append_polygon(mesh, std::array{0u, 1u, 0u, 2u}, 0);
  append_polygon(mesh, std::array{6u, 2u, 0u, 4u}, 0);  // The first face, from another corner on.
  const RepairedMesh repaired = repair_mesh(mesh, "box");
  EXPECT_EQ(count_of(repaired, "degenerate faces removed"), 2u);
  EXPECT_EQ(count_of(repaired, "duplicate faces removed"), 1u);
  EXPECT_EQ(total_volume(repaired), 6);
}

TEST(Repair, ADoubleSidedMeshBecomesOneSided) {
  RawMesh mesh = box();
  add_box(mesh, Vec3::Zero(), Vec3(1, 2, 3), {}, true);
  const RepairedMesh repaired = repair_mesh(mesh, "box");
  EXPECT_EQ(count_of(repaired, "duplicate faces removed"), 6u);
  EXPECT_EQ(total_volume(repaired), 6);
}

TEST(Repair, VerticesOnEdgesBecomeCornersAtTheEdge) {
  RawMesh mesh = box({4});
  mesh.vertices.emplace_back(0.4, 0, 0);  // Divides the -z face, but not the -y face beside it.
  mesh.vertices.emplace_back(0.4, 2, 0);
  append_polygon(mesh, std::array{0u, 2u, 9u, 8u}, 0);
  append_polygon(mesh, std::array{8u, 9u, 3u, 1u}, 0);
  const RepairedMesh repaired = repair_mesh(mesh, "box");
  EXPECT_EQ(count_of(repaired, "T-junctions fixed (vertices inserted into edges)"), 2u);
  EXPECT_EQ(repaired.shells[0].faces.size(), 7u);
  EXPECT_EQ(total_volume(repaired), 6);
}

TEST(Repair, TouchingSolidsAreSeparated) {
  RawMesh mesh = box();
  add_box(mesh, Vec3(1, 2, 0), Vec3(2, 3, 3));     // Touches in an edge.
  add_box(mesh, Vec3(0, 0, 3), Vec3(1, 2, 4));     // Touches in a face.
  add_box(mesh, Vec3(-1, -1, -1), Vec3(0, 0, 0));  // Touches in a vertex.
  const RepairedMesh repaired = repair_mesh(mesh, "boxes");
  EXPECT_EQ(repaired.shells.size(), 4u);
  EXPECT_EQ(total_volume(repaired), 6 + 3 + 2 + 1);
}

TEST(Repair, ACavityStaysWithTheShellAroundIt) {
  RawMesh mesh = box();
  add_box(mesh, Vec3::Constant(0.25), Vec3::Constant(0.75), {}, true);
  add_box(mesh, Vec3(5, 0, 0), Vec3(6, 1, 1), {}, true);
  const RepairedMesh repaired = repair_mesh(mesh, "boxes");
  ASSERT_EQ(repaired.shells.size(), 2u);
  EXPECT_EQ(mass_properties(repaired.shells[0]).volume_m3, 6 - 0.125);
  EXPECT_EQ(total_volume(repaired), 6 - 0.125 + 1);
}

TEST(Repair, UnconnectedSheetsAreEnclosed) {
  RawMesh mesh;  // Six sheets, each too small to meet the others.
  for (int f = 0; f < 6; ++f) {
    std::set<int> others = {0, 1, 2, 3, 4, 5};
    others.erase(f);
    RawMesh sheet;
    add_box(sheet, Vec3::Zero(), Vec3::Ones(), others);
    const Vec3 center =
        0.25 * (sheet.vertices[sheet.corners[0]] + sheet.vertices[sheet.corners[1]] +
                sheet.vertices[sheet.corners[2]] + sheet.vertices[sheet.corners[3]]);
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t v : sheet.corners) {
      corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(center + 0.95 * (sheet.vertices[v] - center));
    }
    append_polygon(mesh, corners, 0);
  }
  const RepairedMesh repaired = repair_mesh(mesh, "sheets");
  EXPECT_EQ(count_of(repaired, "faces enclosed in a winding-number shell"), 6u);
  EXPECT_EQ(repaired.shells.size(), 1u);
  EXPECT_NEAR(total_volume(repaired), 1, 0.05);
}

/// Returns a prism over an outline in x and y from z = 0 to 1.
PolygonMesh prism_over(const std::vector<Vec2>& outline) {
  const auto count = static_cast<std::uint32_t>(outline.size());
  PolygonMesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const Vec2& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  }
  const auto add = [&](const std::vector<std::uint32_t>& corners, const Vec3& normal) {
    PolygonMesh::Face face;
    face.plane = Plane::through(mesh.vertices[corners[0]], normal);
    face.first_contour = static_cast<std::uint32_t>(mesh.contours.size());
    face.contour_count = 1;
    mesh.contours.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                             static_cast<std::uint32_t>(corners.size())});
    mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
    mesh.faces.push_back(face);
  };
  std::vector<std::uint32_t> top, bottom;
  for (std::uint32_t i = 0; i < count; ++i) {
    top.push_back(count + i);
    bottom.insert(bottom.begin(), i);
    const std::uint32_t next = (i + 1) % count;
    const Vec2 along = outline[next] - outline[i];
    add({i, next, count + next, count + i}, Vec3(along.y(), -along.x(), 0).normalized());
  }
  add(top, Vec3::UnitZ());
  add(bottom, -Vec3::UnitZ());
  return mesh;
}

/// A square of area 2 on its corner, and, beyond the crossing, one of area 0.5 that winds
/// backwards.
const std::vector<Vec2> kBowTie = {{-2, 0}, {-1, -1}, {0.5, 0.5}, {1, 0}, {0.5, -0.5}, {-1, 1}};

TEST(InsideOut, VolumeIsThatOfTheLobesThatWindBackwards) {
  EXPECT_EQ(inside_out_volume(prism_over({{0, 0}, {1, 0}, {1, 1}, {0, 1}})), 0);
  EXPECT_NEAR(inside_out_volume(prism_over({{0, 0}, {0, 1}, {1, 1}, {1, 0}})), 1, 1e-12);
  EXPECT_NEAR(inside_out_volume(prism_over(kBowTie)), 0.5, 0.01);
  // Backwards twice where the contour goes around twice.
  EXPECT_NEAR(inside_out_volume(
                  prism_over({{0, 0}, {0, 2}, {1, 2}, {1, 0}, {0, 0}, {0, 2}, {1, 2}, {1, 0}})),
              4, 1e-12);
  // A cavity is not inside out.
  RawMesh hollow = box();
  add_box(hollow, Vec3(0.25, 0.25, 0.25), Vec3(0.75, 1.75, 2.75), {}, true);
  const RepairedMesh repaired = repair_mesh(hollow, "hollow");
  ASSERT_EQ(repaired.shells.size(), 1u);
  EXPECT_EQ(inside_out_volume(repaired.shells[0]), 0);
}

TEST(InsideOut, VolumeIsTheSameFromAnyDirection) {
  PolygonMesh mesh = prism_over(kBowTie);
  for (int turn = 0; turn < 20; ++turn) {
    const Mat3 by =
        Eigen::AngleAxisd(0.37 * turn, Vec3(1, 0.3 * turn, 2).normalized()).toRotationMatrix();
    PolygonMesh turned = mesh;
    for (Vec3& v : turned.vertices) v = by * v;
    for (PolygonMesh::Face& face : turned.faces) face.plane.normal = by * face.plane.normal;
    EXPECT_NEAR(inside_out_volume(turned), 0.5, 0.03) << turn;
  }
}

TEST(Repair, AMeshThatIsInsideOutInPartIsEnclosed) {
  const PolygonMesh prism = prism_over(kBowTie);
  RawMesh raw;
  raw.vertices = prism.vertices;
  for (std::size_t c = 0; c < prism.contours.size(); ++c) {
    const auto corners = prism.contour_corners(c);
    append_polygon(raw, std::vector<std::uint32_t>(corners.begin(), corners.end()), 0);
  }
  const RepairedMesh repaired = repair_mesh(raw, "bow tie");
  EXPECT_EQ(count_of(repaired, "faces enclosed in a winding-number shell"), 8u);
  EXPECT_NEAR(total_volume(repaired), 2, 0.1);
  EXPECT_THROW(repair_mesh(raw, "bow tie", {.repair = false}), InputError);
}

TEST(Repair, ASheetWithoutVolumeIsRefused) {
  EXPECT_THROW(repair_mesh(box({0, 1, 2, 3, 4}), "sheet"), InputError);
  EXPECT_THROW(repair_mesh(RawMesh(), "nothing"), InputError);
}

TEST(Repair, PolygonsThatAreNotPlanarBecomeTriangles) {
  RawMesh mesh = box();
  mesh.vertices[7] += Vec3(0.1, 0.2, 0.3);
  const RepairedMesh repaired = repair_mesh(mesh, "box", {.repair = false});
  EXPECT_EQ(count_of(repaired, "faces triangulated because they are not planar"), 3u);
  EXPECT_EQ(repaired.shells[0].faces.size(), 9u);
  total_volume(repaired);
}

TEST(Repair, SmoothNormalsStopAtCreases) {
  RawMesh prism;  // A column of 24 sides, with smooth sides and sharp rims.
  constexpr std::uint32_t kSides = 24;
  std::vector<std::uint32_t> bottom, top;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const SinCos at = sin_cos(2 * 3.14159265358979 * i / kSides);
    prism.vertices.emplace_back(at.cos, at.sin, 0);
    prism.vertices.emplace_back(at.cos, at.sin, 1);
    bottom.insert(bottom.begin(), 2 * i);
    top.push_back(2 * i + 1);
    const std::uint32_t next = (i + 1) % kSides;
    append_polygon(prism, std::array{2 * i, 2 * next, 2 * next + 1, 2 * i + 1}, 0);
  }
  append_polygon(prism, bottom, 0);
  append_polygon(prism, top, 0);
  const RepairedMesh repaired = repair_mesh(prism, "column");
  const PolygonMesh& mesh = repaired.shells[0];
  for (const PolygonMesh::Face& face : mesh.faces) {
    const bool side = std::abs(face.plane.normal.z()) < 0.5;
    const PolygonMesh::Contour& contour = mesh.contours[face.first_contour];
    for (std::uint32_t i = 0; i < contour.corner_count; ++i) {
      const std::uint32_t c = contour.first_corner + i;
      Vec3 expected = mesh.vertices[mesh.corners[c]];
      expected.z() = 0;
      if (!side) expected = face.plane.normal;
      EXPECT_NEAR((mesh.corner_normals[c].cast<double>() - expected).norm(), 0, 1e-6);
    }
  }
}

TEST(Repair, NormalsOfTheFileAreKeptAndFlippedWithTheirFaces) {
  RawMesh mesh;
  add_box(mesh, Vec3::Zero(), Vec3::Ones(), {}, true);
  for (const RawMesh::Polygon& polygon : mesh.polygons) {
    const auto face = static_cast<std::size_t>(&polygon - mesh.polygons.data());
    const Vec3 normal = (double_area(mesh, face).normalized() + Vec3(0.1, 0, 0)).normalized();
    for (int i = 0; i < 4; ++i) mesh.corner_normals.push_back(normal.cast<float>());
  }
  const std::vector<Vec3f> given = mesh.corner_normals;
  const RepairedMesh repaired = repair_mesh(mesh, "box");
  for (std::size_t c = 0; c < given.size(); ++c) {
    EXPECT_NEAR((repaired.shells[0].corner_normals[c] + given[c]).norm(), 0, 1e-6);
  }
}

TEST(Triangulate, CoversConcaveContoursOnce) {
  Random random(3);
  for (const std::size_t n : {5u, 40u, 64u, 65u, 400u}) {
    std::vector<Vec3> star;
    double area = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const SinCos at =
          sin_cos(2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(n));
      star.push_back(random.uniform(0.3, 1) * Vec3(at.cos, at.sin, 0));
    }
    for (std::size_t i = 0; i < n; ++i) area += 0.5 * star[i].cross(star[(i + 1) % n]).z();
    const std::vector<Triangle> triangles = triangulate(star);
    EXPECT_EQ(triangles.size(), n - 2);
    double sum = 0;
    for (const Triangle& t : triangles) {
      const double one = 0.5 * (star[t[1]] - star[t[0]]).cross(star[t[2]] - star[t[0]]).z();
      EXPECT_GE(one, -1e-12);
      sum += one;
    }
    EXPECT_NEAR(sum, area, 1e-12);
  }
}

TEST(Winding, IsOneInsideAndZeroOutside) {
  std::vector<std::array<Vec3, 3>> triangles;
  const RawMesh mesh = box();
  for (std::size_t p = 0; p < 6; ++p) {
    const auto c = mesh.polygon_corners(p);
    triangles.push_back({mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]});
    triangles.push_back({mesh.vertices[c[0]], mesh.vertices[c[2]], mesh.vertices[c[3]]});
  }
  const WindingField field(triangles);
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p(random.uniform(-4, 5), random.uniform(-4, 5), random.uniform(-4, 5));
    const bool inside = (p.array() > 0).all() && (p.array() < Eigen::Array3d(1, 2, 3)).all();
    EXPECT_NEAR(field.at(p), inside ? 1 : 0, 0.02);
  }
}

TEST(Winding, ArcTangentIsExact) {
  for (double angle = -3.1415; angle < 3.1415; angle += 0.001) {
    EXPECT_NEAR(arc_tangent(3 * std::sin(angle), 3 * std::cos(angle)), angle, 2e-15);
  }
  EXPECT_EQ(arc_tangent(0, 0), 0);
  EXPECT_EQ(arc_tangent(0, 2), 0);
  EXPECT_NEAR(arc_tangent(0, -2), 3.14159265358979323846, 1e-15);
  EXPECT_NEAR(arc_tangent(-1e-300, 0), -1.57079632679489661923, 1e-15);
}

TEST(Repair, AnySoupEndsInTime) {
  Random random(9);
  const auto point = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()); };
  RawMesh soup;  // Triangles that all overlap.
  for (std::uint32_t t = 0; t < 10000; ++t) {
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(point());
    append_polygon(soup, std::array{3 * t, 3 * t + 1, 3 * t + 2}, 0);
  }
  RawMesh fans;  // Polygons with very many corners.
  for (std::uint32_t p = 0; p < 20; ++p) {
    std::vector<std::uint32_t> polygon;
    for (int k = 0; k < 1900 + 20 * static_cast<int>(p); ++k) {
      polygon.push_back(static_cast<std::uint32_t>(fans.vertices.size()));
      fans.vertices.push_back(point());
    }
    append_polygon(fans, polygon, 0);
  }
  for (const RawMesh& mesh : {soup, fans}) {
    const double start_s = test::cpu_time_s();
    try {
      total_volume(repair_mesh(mesh, "soup"));
    } catch (const InputError&) {
    }
    const double took_s = test::cpu_time_s() - start_s;
    EXPECT_LT(took_s, 20 * kTimeFactor);  // A generous bound, not a measurement.
  }
}

TEST(RealMeshes, GoodOnesNeedNoRepair) {
  for (const auto& file : test::meshes("good")) {
    const std::string name = file.filename().string();
    const RepairedMesh repaired = repair_mesh(read_mesh(file), name, {.repair = false});
    EXPECT_TRUE(repaired.closed) << name;
    EXPECT_FALSE(repaired.shells.empty()) << name;
    EXPECT_GT(total_volume(repaired), 0) << name;
  }
}

TEST(RealMeshes, DefectiveOnesBecomeSolidsOrAreRefusedInOneLine) {
  std::set<std::string> refused;
  for (const auto& file : test::meshes("nasty")) {
    const std::string name = file.filename().string();
    const double start_s = test::cpu_time_s();
    try {
      const RepairedMesh repaired = repair_mesh(read_mesh(file), name);
      EXPECT_GT(total_volume(repaired), 0) << name;
      EXPECT_TRUE(repaired.closed || !repaired.repairs.empty()) << name;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      refused.insert(name);
    }
    const double took_s = test::cpu_time_s() - start_s;
    EXPECT_LT(took_s, 5 * kTimeFactor) << name;
  }
  for (const std::string& name : refused) {
    for (const char* kit : {"kaykit_", "kenney_", "bunny_"}) EXPECT_NE(name.rfind(kit, 0), 0u);
  }
}

}  // namespace
}  // namespace sunder
