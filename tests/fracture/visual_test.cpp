// Tests of convexes with visual meshes: cuts, welds, bonds, corner attributes and drawn surfaces.
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/trigonometry.h"
#include "engine/model/piece_mesh.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/cut/intersect.h"
#include "fracture/cut/surface.h"
#include "fracture/stress/bond_geometry.h"
#include "fracture/vacd/vacd.h"
#include "tests/engine/geometry_mesh_fixtures.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/visual_truths.h"

namespace sunder::fracture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns the mesh as a file would give it, with no face marked as a cap.
PolygonMesh original(PolygonMesh mesh) {
  for (PolygonMesh::Face& face : mesh.faces) {
    face.id = {};
    face.kind = FaceKind::kSurface;
  }
  return mesh;
}

PolygonMesh box_mesh(const Vec3& min, const Vec3& max) {
  return original(polygon_mesh(make_box(min, max)));
}

BreakCommand impact(PatternSpec::Kind kind, int cells, const Vec3& at = Vec3::Zero(),
                    double radius = kInfinity, std::uint64_t event = 1) {
  BreakCommand command;
  command.event = command.seed = event;
  command.pattern.kind = kind;
  command.pattern.cells = cells;
  command.pattern.falloff = 1;
  command.X_RP.position = at;
  command.radius_m = radius;
  return command;
}

std::size_t count_internal(const BreakPlan& plan) {
  std::size_t count = 0;
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) count += convex->is_internal();
  }
  return count;
}

TEST(Visual, every_kind_of_mesh_keeps_the_invariants) {
  const PatternSpec::Kind kinds[] = {PatternSpec::Kind::kVoronoi, PatternSpec::Kind::kGrid,
                                     PatternSpec::Kind::kSlabs, PatternSpec::Kind::kWeb,
                                     PatternSpec::Kind::kBrick};
  const PolygonMesh meshes[] = {test::comb(4), test::ring(), test::hollow_box(),
                                test::torus(24, 10)};
  std::uint64_t event = 0;
  for (const PolygonMesh& mesh : meshes) {
    const Compound solid = solid_of(original(mesh));
    for (const PatternSpec::Kind kind : kinds) {
      for (const double radius : {0.7, kInfinity}) {
        const int cells = kind == PatternSpec::Kind::kGrid ? 4 : 20;
        const BreakPlan plan =
            break_compound(solid, impact(kind, cells, Vec3(.1, .2, .3), radius, ++event));
        EXPECT_EQ(find_visual_violation(solid, plan), "")
            << "event " << event << " of kind " << static_cast<int>(kind);
        EXPECT_EQ(plan.failed, 0u) << "event " << event;
      }
    }
  }
}

TEST(Visual, cells_wholly_inside_become_internal_convexes) {
  const Compound solid = solid_of(box_mesh(Vec3::Constant(-1), Vec3::Constant(1)));
  const BreakPlan plan = break_compound(solid, impact(PatternSpec::Kind::kVoronoi, 200));
  EXPECT_EQ(find_visual_violation(solid, plan), "");
  EXPECT_GT(count_internal(plan), 10u);
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) {
      const bool reaches =
          convex->box.min.minCoeff() < -1 + 1e-9 || convex->box.max.maxCoeff() > 1 - 1e-9;
      EXPECT_EQ(convex->is_internal(), !reaches);
      if (!convex->is_internal()) continue;
      for (const auto& face : convex->polyhedron.faces) {
        EXPECT_EQ(face.kind, FaceKind::kInterior);
        EXPECT_FALSE(face.id.none());
      }
    }
  }
}

TEST(Visual, a_convex_in_one_cell_is_assigned_to_that_cell) {
  const Pattern pattern = grid_pattern(2);
  const AlignedPattern aligned = align(pattern, {}, 1, {Vec3::Constant(-100), Vec3::Constant(100)});
  const ConvexPtr small = solid_of(box_mesh(Vec3::Constant(.1), Vec3::Constant(.4))).convexes[0];
  const Intersection cut = intersect(aligned, small, Fit{});
  ASSERT_EQ(cut.parts.size(), 1u);
  EXPECT_EQ(cut.parts[0].convex, small);
  ASSERT_LT(cut.parts[0].cell, aligned.cells.size());
  EXPECT_TRUE(contains(aligned.polyhedron(aligned.cells[cut.parts[0].cell]), Vec3::Constant(.25)));
}

TEST(Visual, only_internal_convexes_weld) {
  const Compound solid = solid_of(box_mesh(Vec3::Constant(-1), Vec3::Constant(1)));
  // The pattern is √3 in size: the middle 5 of its 9 cells along an axis are inside the box.
  BreakCommand command = impact(PatternSpec::Kind::kGrid, 9);
  const BreakPlan first = break_compound(solid, command);
  ASSERT_GT(count_internal(first), 0u);
  Compound whole;  // The pieces of the first break, as one compound again.
  for (const Compound& piece : first.pieces) {
    whole.convexes.insert(whole.convexes.end(), piece.convexes.begin(), piece.convexes.end());
  }
  whole.anchored.assign(whole.convexes.size(), 0);
  whole.bonds = find_contacts(whole.convexes);
  command = impact(PatternSpec::Kind::kVoronoi, 300, Vec3::Zero(), kInfinity, 2);
  const BreakPlan second = break_compound(whole, command);
  EXPECT_GT(second.welded, 0u);
  EXPECT_EQ(find_visual_violation(whole, second), "");
}

TEST(Visual, legs_that_are_cut_off_are_convexes_of_their_own) {
  const Compound comb = solid_of(original(test::comb(2)));  // A U of two legs on a bar.
  PatternSpec slabs;
  BreakCommand command = impact(PatternSpec::Kind::kSlabs, 2);
  command.pattern.jitter = 0;
  // Slabs lie across y; the rotation makes them lie across z, along the bar.
  command.X_RP.rotation = Quat(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitX()));
  const BreakPlan plan = break_compound(comb, command);
  EXPECT_EQ(find_visual_violation(comb, plan), "");
  ASSERT_EQ(plan.pieces.size(), 3u);
  int legs = 0;
  for (const Compound& piece : plan.pieces) {
    ASSERT_EQ(piece.convexes.size(), 1u);
    const Convex& convex = *piece.convexes[0];
    legs += convex.box.max.z() < 0.1;
    EXPECT_EQ(first_cap(*convex.visual) + 1, convex.visual->faces.size());
  }
  EXPECT_EQ(legs, 2);
}

TEST(Visual, convexes_touch_only_where_their_meshes_do) {
  // Two combs back to back in one plane: the fitted faces are squares, the caps are not.
  PolygonMesh comb = original(test::comb(3));
  const auto part = [&](double turn_z) {
    PolygonMesh mesh = comb;
    for (Vec3& v : mesh.vertices) v = Vec3(v.x(), turn_z * v.y(), turn_z * v.z());
    for (PolygonMesh::Face& face : mesh.faces) {
      face.plane.normal = Vec3(face.plane.normal.x(), turn_z * face.plane.normal.y(),
                               turn_z * face.plane.normal.z());
      face.plane.d =
          -face.plane.normal.dot(mesh.vertices[mesh.contour_corners(face.first_contour)[0]]);
      const bool is_cap = std::abs(face.plane.normal.y()) > 0.9 && std::abs(face.plane.d) < 0.1;
      if (is_cap) face.id = PlaneId{turn_z > 0 ? 2u : 3u};
    }
    return mesh;
  };
  const auto convex_of = [&](double side, PlaneId id) {
    PolygonMesh mesh = part(side);
    // The cap must be the last face.
    const auto cap = std::find_if(mesh.faces.begin(), mesh.faces.end(),
                                  [](const auto& face) { return !face.id.none(); });
    const std::size_t at = static_cast<std::size_t>(cap - mesh.faces.begin());
    PolygonMesh sorted = mesh;
    sorted.faces.erase(sorted.faces.begin() + static_cast<std::ptrdiff_t>(at));
    sorted.faces.push_back(mesh.faces[at]);
    ConvexPolyhedron hull = fitted_hull(mesh.vertices, {Fit::Kind::kAabb});
    for (ConvexPolyhedron::Face& face : hull.faces) {
      if (std::abs(face.plane.normal.y()) > 0.9 && std::abs(face.plane.d) < 0.1) face.id = id;
    }
    return make_convex(std::move(hull), MaterialIndex(0u),
                       std::make_shared<PolygonMesh>(std::move(sorted)));
  };
  const ConvexPtr convexes[] = {convex_of(1, PlaneId{2}), convex_of(-1, PlaneId{3})};
  const std::vector<Bond> bonds = find_contacts(convexes);
  ASSERT_EQ(bonds.size(), 1u);
  // The upper comb's teeth point to −z, the lower one's to +z: bars of depth 0.5 over teeth of
  // width 0.4, three on either side, and the teeth between the bars over each other.
  EXPECT_NEAR(bonds[0].area_m2, 2 * 3 * 0.5 * 0.4 + 3 * 0.4 * 1.0, 1e-12);
}

TEST(Visual, the_bond_of_a_hollow_solid_has_the_shape_of_its_caps) {
  VacdOptions options;
  options.nodes = {Vec3(0, -0.5, 0), Vec3(0, 0.5, 0)};
  const Compound halves = decompose({{original(test::hollow_box())}, {}, true}, options).compound;
  ASSERT_EQ(halves.bonds.size(), 1u);
  const BondGeometry ring = bond_geometry(halves, halves.bonds[0]);
  const double outer = 2, inner = 1;
  EXPECT_NEAR(ring.area_m2, outer * outer - inner * inner, 1e-12);
  EXPECT_LT(ring.centroid_R.norm(), 1e-12);
  const double moment = (std::pow(outer, 4) - std::pow(inner, 4)) / 12;
  EXPECT_LT((ring.second_moment - Mat3(Vec3(moment, 0, moment).asDiagonal())).norm(), 1e-12);
  EXPECT_NEAR(ring.reach_m, outer / std::sqrt(2), 1e-12);
  EXPECT_EQ(bond_corners(halves, halves.bonds[0]).size(), 8u);
}

TEST(Visual, corner_attributes_are_interpolated_along_cuts) {
  PolygonMesh mesh = original(test::torus(40, 20));
  // Round normals, and texture coordinates that are a linear map of space.
  mesh.corner_uvs.resize(mesh.corners.size());
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    const Vec3& p = mesh.vertices[mesh.corners[c]];
    const Vec3 ring = 0.7 * Vec3(p.x(), 0, p.z()).normalized();
    mesh.corner_normals[c] = (p - ring).normalized().cast<float>();
    mesh.corner_uvs[c] = Vec2f(static_cast<float>(2 * p.x()), static_cast<float>(p.y() - p.z()));
  }
  const BreakPlan plan = break_compound(solid_of(mesh), impact(PatternSpec::Kind::kVoronoi, 30));
  ASSERT_GT(plan.pieces.size(), 10u);
  std::size_t caps = 0;
  for (const Compound& piece : plan.pieces) {
    for (const ConvexPtr& convex : piece.convexes) {
      if (convex->is_internal()) continue;
      const PolygonMesh& visual = *convex->visual;
      ASSERT_EQ(visual.corner_uvs.size(), visual.corners.size());
      for (std::size_t f = 0; f < visual.faces.size(); ++f) {
        const PolygonMesh::Face& face = visual.faces[f];
        for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count;
             ++k) {
          const PolygonMesh::Contour& contour = visual.contours[k];
          for (std::uint32_t c = contour.first_corner;
               c < contour.first_corner + contour.corner_count; ++c) {
            const Vec3& p = visual.vertices[visual.corners[c]];
            if (f >= first_cap(visual)) {
              EXPECT_LT((visual.corner_normals[c] - face.plane.normal.cast<float>()).norm(), 1e-6);
              const Vec2f flat = visual.corner_uvs[c];  // Coordinates in metres of the rest frame.
              EXPECT_LE(std::abs(flat.x()), 1.1f);
              caps += k == face.first_contour;
              continue;
            }
            const Vec3 round = (p - 0.7 * Vec3(p.x(), 0, p.z()).normalized()).normalized();
            EXPECT_GT(visual.corner_normals[c].cast<double>().dot(round), 0.97);
            EXPECT_NEAR(visual.corner_uvs[c].x(), 2 * p.x(), 1e-6);
            EXPECT_NEAR(visual.corner_uvs[c].y(), p.y() - p.z(), 1e-6);
          }
        }
      }
    }
  }
  EXPECT_GT(caps, 20u);
}

TEST(Visual, tighter_fits_enclose_less_and_bonds_remain) {
  const Compound solid = solid_of(original(test::torus(40, 20)));
  double before = kInfinity;
  for (const Fit& fit : {Fit{Fit::Kind::kAabb}, Fit{Fit::Kind::k14Dop}, Fit{Fit::Kind::k26Dop},
                         Fit{Fit::Kind::kHull, 64}}) {
    BreakCommand command = impact(PatternSpec::Kind::kVoronoi, 40, Vec3(.7, 0, 0), 0.3);
    command.fit = fit;
    const BreakPlan plan = break_compound(solid, command);
    ASSERT_TRUE(plan.broke());
    EXPECT_EQ(find_visual_violation(solid, plan), "") << name_of(fit);
    double hulls = 0;
    std::size_t bonds = 0;
    for (const Compound& piece : plan.pieces) {
      bonds += piece.bonds.size();
      for (const ConvexPtr& convex : piece.convexes) {
        hulls += mass_properties(convex->polyhedron).volume_m3;
      }
    }
    EXPECT_LT(hulls, before) << name_of(fit);
    EXPECT_GE(hulls, volume(solid) * (1 - 1e-9));
    EXPECT_GT(bonds, 5u) << name_of(fit);
    before = hulls;
  }
}

double drawn_area(const Compound& piece) {
  double area = 0;
  const auto hidden = hidden_faces(piece);
  for (std::size_t c = 0; c < piece.convexes.size(); ++c) {
    const auto mesh = make_mesh(*piece.convexes[c], hidden[c]);
    if (!mesh) continue;
    for (const Mesh::Vertex& vertex : mesh->vertices) EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
    for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
      const auto at = [&](std::size_t k) { return mesh->vertices[mesh->indices[i + k]]; };
      const Vec3f out = (at(1).position - at(0).position).cross(at(2).position - at(0).position);
      area += 0.5 * static_cast<double>(out.norm());
      if (at(0).look == Mesh::kInterior && out.norm() > 1e-5f) {
        EXPECT_GT(out.normalized().dot(at(0).normal), 0.99f);
      }
    }
  }
  return area;
}

TEST(Visual, the_drawn_surface_is_the_exposed_surface) {
  for (const PolygonMesh& mesh : {test::torus(40, 20), test::ring(), test::hollow_box()}) {
    const Compound solid = solid_of(original(mesh));
    double surface = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) surface += face_area(mesh, f);
    EXPECT_NEAR(drawn_area(solid), surface, 1e-5);
    const BreakPlan plan =
        break_compound(solid, impact(PatternSpec::Kind::kVoronoi, 20, Vec3(.7, .1, 0), 0.4));
    ASSERT_TRUE(plan.broke());
    double drawn = 0;
    for (const Compound& piece : plan.pieces) drawn += drawn_area(piece);
    // Both sides of each crack are drawn, and no cut that did not become a crack.
    EXPECT_NEAR(drawn, surface + 2 * plan.new_area_m2, 1e-4);
  }
}

TEST(Visual, a_break_that_does_not_cut_the_mesh_returns_the_convex) {
  const Compound solid = solid_of(original(test::ring()));
  // The impact is in the middle of the hole: cells cut the convex, but not the mesh.
  const BreakPlan plan =
      break_compound(solid, impact(PatternSpec::Kind::kVoronoi, 10, Vec3(0, .5, 0), 0.05));
  ASSERT_EQ(plan.pieces.size(), 1u);
  EXPECT_EQ(plan.failed, 0u);
}

TEST(Visual, the_same_break_gives_the_same_bits) {
  const Compound solid = solid_of(original(test::torus(30, 12)));
  const BreakCommand command = impact(PatternSpec::Kind::kVoronoi, 25);
  EXPECT_EQ(hash_of(break_compound(solid, command)), hash_of(break_compound(solid, command)));
}

}  // namespace
}  // namespace sunder::fracture
