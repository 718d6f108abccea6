// Tests that case files replay breaks, and of errors in case files.
#include "fracture/check/case_file.h"

#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/geometry/approximate_hull.h"
#include "fracture/pattern_breaker.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/solids.h"

namespace sunder::fracture {
namespace {

BreakCase example(const char* solid = "voronoi:7") {
  BreakCase example{make_solid(solid), {}};
  example.compound.anchored[2] = kAnchoredAllSides;
  example.command.event = 0xfedcba9876543210;
  example.command.seed = 5;
  example.command.pattern.kind = PatternSpec::Kind::kVoronoi;
  example.command.pattern.cells = 30;
  example.command.pattern.file = "a file with \"quotes\"";
  example.command.unbreakable = {MaterialIndex(2u), MaterialIndex(4u)};
  example.command.smallest_m3 = 0.01;
  example.command.stretch_P = Vec3(1, 1. / 3, 1).asDiagonal();
  example.command.X_RP.position = Vec3(.7, .1, .1);
  return example;
}

TEST(CaseFile, replays_to_the_same_bits) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [solid, radius] : {std::pair("voronoi:7", .6), std::pair("voronoi:7", infinity),
                                      std::pair("hall:2", 1.5), std::pair("hall:2", infinity)}) {
    BreakCase written = example(solid);
    written.command.radius_m = radius;
    std::stringstream file;
    write_case(file, written);
    const BreakCase read = read_case(file, "a.case");
    EXPECT_EQ(hash_of(read.compound), hash_of(written.compound));
    EXPECT_EQ(read.compound.anchored, written.compound.anchored);
    EXPECT_EQ(read.command.pattern.file, written.command.pattern.file);
    EXPECT_EQ(read.command.unbreakable, written.command.unbreakable);
    EXPECT_EQ(read.command.smallest_m3, written.command.smallest_m3);
    const BreakPlan again = break_compound(read.compound, read.command);
    EXPECT_TRUE(again.broke());
    EXPECT_EQ(hash_of(again), hash_of(break_compound(written.compound, written.command)));
  }
}

TEST(CaseFile, keeps_a_plug) {
  BreakCase written;
  written.compound = box_compound(Vec3(-1, -1, 0), Vec3(1, 1, 0.3));
  written.command = example().command;
  written.command.X_RP = {Vec3(0.1, 0, 0),
                          Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()))};
  written.command.radius_m = 0.8;
  written.command.plug = Plug{
      {Vec2(.4, 0), Vec2(.1, .35), Vec2(-.3, .2), Vec2(-.2, -.3)}, 0.3, true, 0.2, true, 1, 0.6};
  written.command.plug->clearance = 1.1;
  std::stringstream file;
  write_case(file, written);
  const BreakCase read = read_case(file, "a.case");
  ASSERT_TRUE(read.command.plug);
  EXPECT_EQ(read.command.plug->clearance, 1.1);
  EXPECT_EQ(read.command.plug->section_m, written.command.plug->section_m);
  const BreakPlan again = break_compound(read.compound, read.command);
  EXPECT_TRUE(again.broke());
  EXPECT_EQ(hash_of(again), hash_of(break_compound(written.compound, written.command)));
}

TEST(CaseFile, is_written_for_a_failed_break_with_its_solid_and_seed) {
  // A convex that claims more volume than it has; the volumes of its parts cannot add up to it.
  auto inconsistent =
      std::make_shared<Convex>(*box_compound(Vec3::Zero(), Vec3::Ones()).convexes[0]);
  inconsistent->solid.volume_m3 *= 1.5;
  Compound solid = box_compound(Vec3::Zero(), Vec3::Ones());
  solid.convexes[0] = inconsistent;

  const std::string folder = testing::TempDir();
  const auto log = std::make_shared<FailureLog>(folder, 2);
  const auto breaker = make_pattern_breaker(log);
  BreakCommand command = example().command;
  for (command.event = 7001; command.event < 7004; ++command.event) {
    EXPECT_EQ(breaker->plan(Structure(solid), command).loose.failed, 1u);
  }
  EXPECT_EQ(log->failed(), 0u);  // No break has been applied.
  breaker->on_applied(breaker->plan(Structure(solid), command).loose);
  EXPECT_EQ(log->failed(), 1u);
  EXPECT_DOUBLE_EQ(log->failed_m3(), 1.5);
  EXPECT_EQ(log->files(), 2u);
  for (const char* name : {"/break-7001.case", "/break-7002.case"}) {
    std::ifstream file(folder + name);
    const BreakCase read = read_case(file, name);
    EXPECT_EQ(hash_of(read.compound), hash_of(solid));
    EXPECT_EQ(read.command.seed, command.seed);
    std::remove((folder + name).c_str());
  }
  EXPECT_FALSE(std::ifstream(folder + "/break-7003.case").good());
}

TEST(CaseFile, is_not_written_for_a_successful_break) {
  const auto log = std::make_shared<FailureLog>(testing::TempDir());
  const auto breaker = make_pattern_breaker(log);
  EXPECT_TRUE(breaker->plan(Structure(example().compound), example().command).changed);
  EXPECT_EQ(log->failed(), 0u);
  EXPECT_EQ(log->files(), 0u);
}

TEST(CaseFile, keeps_visual_meshes_and_the_fit) {
  PolygonMesh mesh = polygon_mesh(make_box(Vec3(0, 0, 0), Vec3(1, 2, 3)));
  for (const std::uint32_t corner : mesh.corners) {
    mesh.corner_uvs.push_back(mesh.vertices[corner].head<2>().cast<float>());
  }
  BreakCase written = example();
  ConvexPolyhedron hull = make_box(Vec3(-.1, 0, 0), Vec3(1, 2.1, 3));
  auto visual = std::make_shared<const PolygonMesh>(mesh);
  written.compound = make_compound({{hull, MaterialIndex(1u), 0, visual}});
  written.command.fit = {Fit::Kind::kHull, 12};
  written.command.radius_m = std::numeric_limits<double>::infinity();
  std::stringstream file;
  write_case(file, written);
  const BreakCase read = read_case(file, "a.case");
  EXPECT_EQ(hash_of(read.compound), hash_of(written.compound));
  ASSERT_TRUE(read.compound.convexes[0]->visual);
  EXPECT_EQ(read.compound.convexes[0]->visual->corner_uvs, mesh.corner_uvs);
  EXPECT_EQ(name_of(read.command.fit), "hull:12");
  const BreakPlan again = break_compound(read.compound, read.command);
  EXPECT_TRUE(again.broke());
  EXPECT_EQ(hash_of(again), hash_of(break_compound(written.compound, written.command)));
}

TEST(CaseFile, with_an_invalid_pattern_pose_or_bond_is_an_error) {
  const auto refused = [](const auto& invalidate) {
    BreakCase invalid = example();
    invalidate(invalid);
    std::stringstream file;
    write_case(file, invalid);
    EXPECT_THROW(read_case(file, "spoilt.case"), InputError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double radius : {0., -1., nan})
    refused([&](BreakCase& invalid) { invalid.command.radius_m = radius; });
  refused([](BreakCase& invalid) { invalid.command.stretch_P.setZero(); });
  refused([](BreakCase& invalid) { invalid.command.X_RP.rotation.coeffs().setZero(); });
  refused([&](BreakCase& invalid) { invalid.command.X_RP.position.x() = nan; });
  refused([](BreakCase& invalid) { invalid.compound.bonds[0].b = invalid.compound.bonds[0].a; });
}

TEST(CaseFile, cut_short_anywhere_is_an_error) {
  std::stringstream file;
  write_case(file, example("hall:2"));
  const std::string text = file.str();
  for (std::size_t length = 0; length + 40 < text.size(); length += 197) {
    std::istringstream part(text.substr(0, length));
    EXPECT_THROW(read_case(part, "a.case"), InputError) << length;
  }
}

TEST(CaseFile, cut_short_between_words_is_reported_as_such) {
  std::stringstream file;
  write_case(file, example());
  const std::string text = file.str();
  std::istringstream part(text.substr(0, text.find('\n', text.size() / 2)));
  try {
    read_case(part, "a.case");
    FAIL() << "it was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ends too early"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sunder::fracture
