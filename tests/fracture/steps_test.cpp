// Tests of each step of a fracture by itself.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/clip.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/adjacency/islands.h"
#include "fracture/cut/fragments.h"
#include "fracture/cut/intersect.h"
#include "fracture/cut/weld.h"
#include "fracture/fracture.h"
#include "fracture/solids.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

const Box kWorld{Vec3::Constant(-100), Vec3::Constant(100)};

Mat3 skewed() {
  Mat3 linear;
  linear << 1, .3, 0, -.2, .8, .1, .1, 0, 1.4;
  return linear;
}

double part_volume(const Intersection& cut) {
  return std::accumulate(
      cut.parts.begin(), cut.parts.end(), cut.debris_volume_m3,
      [](double sum, const CellPart& part) { return sum + part.convex->solid.volume_m3; });
}

TEST(Align, moves_planes_cells_and_volumes_by_any_linear_map) {
  const Pattern pattern = voronoi_pattern(20, 1, false, 3);
  const Placement placement{skewed(), Vec3(1, 2, 3)};
  const AlignedPattern aligned = align(pattern, placement, 9, kWorld);
  ASSERT_EQ(aligned.cells.size(), pattern.cells.size());
  for (const AlignedPattern::Cell& cell : aligned.cells) {
    const Cell& original = pattern.cells[cell.index];
    const ConvexPolyhedron moved = aligned.polyhedron(cell);
    EXPECT_NEAR(cell.volume, original.volume * skewed().determinant(), 1e-12 * cell.volume);
    EXPECT_NEAR(mass_properties(moved).volume_m3, cell.volume, 1e-11 * cell.volume);
    for (std::size_t f = 0; f < moved.faces.size(); ++f) {
      const PlaneId id = original.polyhedron.faces[f].id;
      EXPECT_EQ(moved.faces[f].id, aligned.name(id));
      EXPECT_NEAR(aligned.plane(id).normal.norm(), 1, 1e-14);
      for (const std::uint32_t corner : moved.face_corners(f)) {
        EXPECT_NEAR(aligned.plane(id).distance(moved.vertices[corner]), 0, 1e-12);
      }
    }
  }
}

TEST(Align, keeps_the_origin_on_the_impact_and_opposite_names_on_the_sides_of_a_plane) {
  const Pattern pattern = grid_pattern(2);
  const AlignedPattern aligned = align(pattern, {skewed(), Vec3(4, 5, 6)}, 1, kWorld);
  int at_impact = 0;  // Eight cubes meet at the origin.
  for (const AlignedPattern::Cell& cell : aligned.cells) {
    for (const Vec3& vertex : aligned.cell_vertices(cell)) {
      at_impact += (vertex - Vec3(4, 5, 6)).norm() < 1e-12;
    }
  }
  EXPECT_EQ(at_impact, 8);
  for (std::uint32_t i = 0; i < pattern.planes.size(); ++i) {
    EXPECT_EQ(aligned.name(pattern_plane(i, true)),
              aligned.name(pattern_plane(i, false)).opposite());
  }
}

TEST(Align, names_planes_after_the_event) {
  const Pattern pattern = grid_pattern(2);
  const AlignedPattern first = align(pattern, {}, 1, kWorld),
                       second = align(pattern, {}, 2, kWorld);
  EXPECT_NE(first.name(pattern_plane(7, false)), second.name(pattern_plane(7, false)));
}

TEST(Intersect, gives_each_cell_its_part_and_the_far_cell_the_rest) {
  const Pattern pattern = grid_pattern(2);
  const AlignedPattern aligned = align(pattern, {.1 * Mat3::Identity(), Vec3::Zero()}, 1, kWorld);
  const ConvexPtr box = box_compound(Vec3::Constant(-3), Vec3::Constant(3)).convexes[0];
  const Intersection cut = intersect(aligned, box);
  EXPECT_FALSE(cut.failed);
  EXPECT_NEAR(part_volume(cut), 216, 216e-12);
  double far = 0;
  for (const CellPart& part : cut.parts) {
    if (part.cell == CellPart::kFarCell) far += part.convex->solid.volume_m3;
    for (const auto& face : part.convex->polyhedron.faces) {
      EXPECT_NE(face.kind == FaceKind::kInterior, face.id.none() || face.id.value < 100);
    }
  }
  EXPECT_NEAR(far, 216 - std::pow(3.2, 3), 1e-9);
}

TEST(Intersect, returns_the_same_object_for_a_convex_in_one_cell) {
  const AlignedPattern aligned = align(grid_pattern(2), {}, 1, kWorld);
  const ConvexPtr box = box_compound(Vec3::Constant(.1), Vec3::Constant(.9)).convexes[0];
  const Pattern pattern = grid_pattern(2);
  const Intersection cut = intersect(align(pattern, {}, 1, kWorld), box);
  ASSERT_EQ(cut.parts.size(), 1u);
  EXPECT_EQ(cut.parts[0].convex, box);
}

TEST(Intersect, blends_corner_normals_along_cut_edges) {
  const Compound column = make_solid("column:1,4");
  const Pattern pattern = grid_pattern(2);
  const Mat3 rotation = Quat(.9, .1, .3, .2).normalized().toRotationMatrix();
  const Intersection cut =
      intersect(align(pattern, {3 * rotation, Vec3(.1, .2, .3)}, 1, kWorld), column.convexes[0]);
  ASSERT_GT(cut.parts.size(), 4u);
  int round = 0;
  for (const CellPart& part : cut.parts) {
    const ConvexPolyhedron& polyhedron = part.convex->polyhedron;
    for (const auto& face : polyhedron.faces) {
      for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
        const Vec3 normal = polyhedron.corner_normals[c].cast<double>();
        EXPECT_NEAR(normal.norm(), 1, 1e-6);
        if (face.kind == FaceKind::kInterior || std::abs(face.plane.normal.y()) > .5) {
          EXPECT_NEAR(normal.dot(face.plane.normal), 1, 1e-6);  // A flat face.
          continue;
        }
        // A side is shaded round: the normal is radial on the edges, and a blend of both between
        // them.
        Vec3 radial = polyhedron.vertices[polyhedron.corners[c]];
        radial.y() = 0;
        EXPECT_NEAR(normal.dot(radial.normalized()), 1, 1e-3);
        ++round;
      }
    }
  }
  EXPECT_GT(round, 100);
}

TEST(Weld, makes_exactly_the_cell_of_parts_that_fill_it) {
  const Pattern pattern = voronoi_pattern(20, 1, false, 3);
  const AlignedPattern aligned = align(pattern, {skewed(), Vec3::Zero()}, 1, kWorld);
  const Compound halves =
      make_compound({{make_box(Vec3(-9, -9, -9), Vec3(.2, 9, 9)), MaterialIndex(0u), 0},
                     {make_box(Vec3(.2, -9, -9), Vec3(9, 9, 9)), MaterialIndex(0u), 0}});
  int welded = 0;
  for (std::uint32_t c = 0; c < aligned.cells.size(); ++c) {
    if (pattern.cells[aligned.cells[c].index].outer) continue;
    std::vector<ConvexPtr> parts;
    for (const ConvexPtr& half : halves.convexes) {
      for (const CellPart& part : intersect(aligned, half).parts) {
        if (part.cell == c) parts.push_back(part.convex);
      }
    }
    if (parts.size() < 2) continue;
    const ConvexPtr whole = weld(aligned, aligned.cells[c], parts, {});
    ASSERT_TRUE(whole);
    const ConvexPolyhedron cell = aligned.polyhedron(aligned.cells[c]);
    EXPECT_EQ(whole->polyhedron.vertices, cell.vertices);
    EXPECT_EQ(whole->polyhedron.corners, cell.corners);
    ++welded;
    parts.pop_back();
    const ConvexPtr rest = weld(aligned, aligned.cells[c], parts, {});
    ASSERT_TRUE(rest);
    EXPECT_NEAR(rest->solid.volume_m3, parts[0]->solid.volume_m3, 1e-12) << "not the cell";
    parts.push_back(make_convex(cell, MaterialIndex(1u)));
    // The last part has another material.
    EXPECT_FALSE(weld(aligned, aligned.cells[c], parts, {}));
  }
  EXPECT_GT(welded, 3);
}

/// Returns the parts of a compound by the cell of a pattern that they lie in.
std::vector<std::vector<ConvexPtr>> parts_by_cell(const AlignedPattern& pattern,
                                                  const Compound& compound) {
  std::vector<std::vector<ConvexPtr>> parts(pattern.cells.size());
  for (const ConvexPtr& convex : compound.convexes)
    for (const CellPart& part : intersect(pattern, convex).parts)
      parts[part.cell].push_back(part.convex);
  return parts;
}

/// Returns the cell of a pattern in which a whole compound lies.
const AlignedPattern::Cell& cell_around(const AlignedPattern& pattern, const Compound& compound) {
  const auto parts = parts_by_cell(pattern, compound);
  const auto all = [&](const auto& of_cell) { return of_cell.size() == compound.convexes.size(); };
  const auto found = std::ranges::find_if(parts, all);
  if (found == parts.end()) throw std::logic_error("no cell has all convexes");
  return pattern.cells[static_cast<std::size_t>(found - parts.begin())];
}

TEST(Weld, keeps_the_outer_faces_of_parts_that_do_not_fill_the_cell) {
  const Pattern pattern = voronoi_pattern(60, 1, false, 3);
  const AlignedPattern aligned =
      align(pattern, {4 * Mat3::Identity(), Vec3(.1, .03, .02)}, 1, kWorld);
  // A beam of two parts, within the cells across.
  const Compound beam =
      make_compound({{make_box(Vec3(-3, -.2, -.3), Vec3(.2, .2, .3)), MaterialIndex(0u), 0},
                     {make_box(Vec3(.2, -.2, -.3), Vec3(3, .2, .3)), MaterialIndex(0u), 0}});
  int welded = 0;
  const auto parts = parts_by_cell(aligned, beam);
  for (std::size_t c = 0; c < parts.size(); ++c) {
    if (parts[c].size() < 2) continue;
    const ConvexPtr whole = weld(aligned, aligned.cells[c], parts[c], {});
    ASSERT_TRUE(whole);
    EXPECT_TRUE(is_closed(whole->polyhedron));
    double volume_m3 = 0;
    for (const ConvexPtr& part : parts[c]) volume_m3 += part->solid.volume_m3;
    EXPECT_NEAR(whole->solid.volume_m3, volume_m3, 1e-12);
    int outer = 0;
    for (const auto& face : whole->polyhedron.faces) {
      const auto in_beam = [&](const ConvexPtr& convex) {
        return std::ranges::any_of(convex->polyhedron.faces, [&](const auto& of) {
          return of.id == face.id && of.kind == face.kind;
        });
      };
      outer += std::ranges::all_of(beam.convexes, in_beam);
    }
    EXPECT_GT(outer, 0) << "both halves have these faces in common, as the whole has";
    ++welded;
  }
  EXPECT_GT(welded, 0);
}

TEST(Weld, keeps_apart_what_is_not_convex_together) {
  const Pattern pattern = voronoi_pattern(1, 1, false, 3);
  const AlignedPattern aligned = align(pattern, {20 * Mat3::Identity(), Vec3::Zero()}, 1, kWorld);
  const Compound corner =
      make_compound({{make_box(Vec3(-1, -1, -1), Vec3(0, 1, 1)), MaterialIndex(0u), 0},
                     {make_box(Vec3(0, -1, -1), Vec3(1, 0, 1)), MaterialIndex(0u), 0}});
  const AlignedPattern::Cell& cell = cell_around(aligned, corner);
  EXPECT_FALSE(weld(aligned, cell, corner.convexes, {}));
}

TEST(Weld, keeps_the_round_shading_of_a_column_of_drums) {
  const Compound column = make_solid("column:1,4");
  const ConvexPolyhedron& whole = column.convexes[0]->polyhedron;
  ConvexPolyhedron low, high;
  ClipScratch scratch;
  const Plane middle = Plane::through(Vec3(0, 1.5, 0), Vec3::UnitY());
  ASSERT_EQ(clip(whole, middle, {1000}, 1e-12, low, scratch), PlaneSide::kCut);
  ASSERT_EQ(clip(whole, middle.flipped(), {1001}, 1e-12, high, scratch), PlaneSide::kCut);
  const Compound drums = make_compound({{low, MaterialIndex(0u), 0}, {high, MaterialIndex(0u), 0}});
  const Pattern pattern = voronoi_pattern(1, 1, false, 3);
  const AlignedPattern aligned = align(pattern, {20 * Mat3::Identity(), Vec3::Zero()}, 1, kWorld);
  const ConvexPtr welded = weld(aligned, cell_around(aligned, drums), drums.convexes, {});
  ASSERT_TRUE(welded);
  for (const auto& face : welded->polyhedron.faces) {
    if (std::abs(face.plane.normal.y()) > .5) continue;
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      Vec3 radial = welded->polyhedron.vertices[welded->polyhedron.corners[c]];
      radial.y() = 0;
      const Vec3 normal = welded->polyhedron.corner_normals[c].cast<double>();
      EXPECT_NEAR(normal.dot(radial.normalized()), 1, 1e-3);
    }
  }
}

TEST(Group, keeps_cells_of_a_colour_together_and_convexes_outside_the_sphere_with_the_rest) {
  Pattern pattern = grid_pattern(4);
  join_colors(pattern, 3, 5);
  const Structure wall(grid_compound(8, 1, 8, Vec3::Constant(.5)));
  const ImpactSphere sphere{Vec3(2, .25, 2), .8};
  std::vector<ConvexSlot> touched = sphere.touched(wall);
  const AlignedPattern aligned = align(pattern, {Mat3::Identity(), sphere.center_R}, 1, kWorld);
  const Fragments fragments = make_fragments(wall, touched, aligned, sphere);
  ASSERT_FALSE(fragments.all.empty());
  for (const Fragment& fragment : fragments.all) {
    const bool is_near = fragment.cell != CellPart::kFarCell && sphere.touches(*fragment.convex);
    if (is_near) {
      EXPECT_EQ(fragment.group, pattern.cells[aligned.cells[fragment.cell].index].color);
    } else {
      EXPECT_EQ(fragment.group, Fragment::kRest);
    }
  }
}

TEST(Islands, become_separate_pieces) {
  const Compound two =
      make_compound({{make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), MaterialIndex(0u), 0},
                     {make_box(Vec3(3, 0, 0), Vec3(4, 1, 1)), MaterialIndex(0u), 1},
                     {make_box(Vec3(1, 0, 0), Vec3(2, 1, 1)), MaterialIndex(0u), 0},
                     {make_box(Vec3(3.5, 0, 0), Vec3(5, 1, 1)), MaterialIndex(0u), 0}});
  const std::vector<Compound> islands = split_islands(two);
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_EQ(islands[0].convexes.size(), 2u);
  EXPECT_EQ(islands[0].bonds.size(), 1u);
  EXPECT_EQ(islands[1].ghosts.size(), 1u);
  EXPECT_TRUE(islands[1].is_anchored());
  EXPECT_FALSE(islands[0].is_anchored());
  EXPECT_DOUBLE_EQ(volume(islands[0]) + volume(islands[1]), volume(two));

  const Pattern pattern = grid_pattern(2);  // The pattern misses, but the compound is in two parts.
  const BreakPlan plan =
      fracture(two, pattern, {Mat3::Identity(), Vec3(90, 0, 0)}, {Vec3(90, 0, 0), 1}, 1);
  ASSERT_EQ(plan.pieces.size(), 2u);
  EXPECT_EQ(plan.untouched, 4u);
  EXPECT_EQ(hash_of(plan.pieces[1]), hash_of(islands[1]));
}

}  // namespace
}  // namespace sunder::fracture
