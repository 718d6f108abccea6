// Tests of patterns from .obj files, valid and invalid.
#include <iomanip>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "fracture/fracture.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

std::string as_obj(const std::vector<ConvexPolyhedron>& cells, int digits) {
  std::ostringstream out;
  out << std::setprecision(digits);
  std::size_t first = 1;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    out << "g cell" << c << "\n";
    for (const Vec3& v : cells[c].vertices) {
      out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << "\n";
    }
    for (std::size_t f = 0; f < cells[c].faces.size(); ++f) {
      out << 'f';
      for (const std::uint32_t corner : cells[c].face_corners(f)) out << ' ' << first + corner;
      out << "\n";
    }
    first += cells[c].vertices.size();
  }
  return out.str();
}

std::vector<ConvexPolyhedron> cells_of(const Compound& compound) {
  std::vector<ConvexPolyhedron> cells;
  for (const ConvexPtr& convex : compound.convexes) {
    cells.push_back(transformed(convex->polyhedron, {Vec3(.01, .02, .03), Quat::Identity()}));
  }
  return cells;
}

std::string message_of(const std::string& obj) {
  std::istringstream in(obj);
  try {
    read_pattern(in, "p.obj");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FilePattern, breaks_into_its_cells_even_if_rounded) {
  for (const int digits : {17, 6}) {
    std::istringstream in(as_obj(cells_of(voronoi_compound(20, 3)), digits));
    const Pattern pattern = read_pattern(in, "cells.obj");
    EXPECT_EQ(pattern.cells.size(), 20u + 6);
    const Compound solid = box_compound(Vec3(-.4, -.3, -.4), Vec3(.4, .4, .3));
    const BreakPlan plan = fracture(solid, pattern, {}, {Vec3::Zero(), 2}, 1);
    EXPECT_EQ(find_violation(solid, plan), "") << digits << " digits";
    EXPECT_EQ(plan.failed, 0u);
    EXPECT_GE(plan.pieces.size(), 15u);
    EXPECT_LT(plan.debris_volume_m3, 1e-4 * volume(solid));
  }
}

TEST(FilePattern, groups_of_one_material_stay_together) {
  std::string obj =
      as_obj({make_box(Vec3(-1, -1, -1), Vec3(0, 1, 1)), make_box(Vec3(0, -1, -1), Vec3(1, 0, 1)),
              make_box(Vec3(0, 0, -1), Vec3(1, 1, 1))},
             6);
  obj.insert(obj.find("v "), "usemtl red\n");
  obj.insert(obj.find("v ", obj.find("g cell1")), "usemtl red\n");
  std::istringstream in(obj);
  const Pattern pattern = read_pattern(in, "two.obj");
  const Compound solid = box_compound(Vec3(-.5, -.5, -.5), Vec3(.5, .5, .5));
  const BreakPlan plan = fracture(solid, pattern, {}, {Vec3::Zero(), 2}, 1);
  ASSERT_EQ(plan.pieces.size(), 2u);
  EXPECT_NEAR(std::max(volume(plan.pieces[0]), volume(plan.pieces[1])), 0.75, 1e-12);
  EXPECT_EQ(find_violation(solid, plan), "");
}

TEST(FilePattern, reports_errors_in_a_file) {
  const std::string box = as_obj({make_box(Vec3(-1, -1, -1), Vec3(1, 1, 1))}, 6);
  EXPECT_EQ(message_of(box), "accepted");
  EXPECT_NE(message_of("").find("has no cells"), std::string::npos);
  EXPECT_NE(message_of("g a\nv 1 2\n").find("p.obj:2: a vertex needs"), std::string::npos);
  EXPECT_NE(message_of("g a\nv 1 2 nan\n").find("three numbers"), std::string::npos);
  EXPECT_NE(message_of("g a\nv 0 0 0\nf 1 2 3\n").find("p.obj:3: vertex 2"), std::string::npos);
  EXPECT_NE(message_of("g a\nv 0 0 0\nf 1 1\n").find("three vertices"), std::string::npos);
  EXPECT_NE(message_of("g a\nv 0 0 0\nf 1 x 1\n").find("'x' is no vertex"), std::string::npos);
  EXPECT_EQ(message_of("usemtl red" + box.substr(box.find('\n'))), "accepted") << "without groups";
  const std::string gap = as_obj(
      {make_box(Vec3(-1, -1, -1), Vec3(0, 1, 1)), make_box(Vec3(.5, -1, -1), Vec3(1, 1, 1))}, 6);
  EXPECT_NE(message_of(gap).find("overlap or leave gaps"), std::string::npos);
  const std::string aside = as_obj({make_box(Vec3(1, -1, -1), Vec3(2, 1, 1))}, 6);
  EXPECT_NE(message_of(aside).find("must lie inside"), std::string::npos);
  const std::string far = as_obj({make_box(Vec3(-1, -1, -1), Vec3(20, 1, 1))}, 6);
  EXPECT_NE(message_of(far).find("within 16 units"), std::string::npos);
  std::string dented = box;
  dented.replace(dented.find("v "), 2, "v 0.3 0.3 0.3\nv ");
  EXPECT_NE(message_of(dented), "accepted");
}

}  // namespace
}  // namespace sunder::fracture
