// Tests of the commands on difficult meshes: tangled, overlapping, or large.
#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/io/figures.h"
#include "tests/mesh/mesh_damage.h"
#include "tests/mesh/mesh_files.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// Writes a triangulated unit ball, its vertices moved at random by up to `noise` along each axis.
void write_ball(const std::string& file, std::uint32_t around, double noise, double x = 0,
                bool append = false, std::uint32_t first = 1) {
  std::ofstream out(file, append ? std::ios::app : std::ios::out);
  const std::uint32_t rings = around / 2;
  Random random(around);
  const auto point = [&](double ring, double turn) {
    const double sin_ring = std::sin(ring), cos_ring = std::cos(ring);
    const double sin_turn = std::sin(turn), cos_turn = std::cos(turn);
    const auto moved = [&](double at) { return at + noise * (2 * random.uniform() - 1); };
    out << "v " << x + moved(sin_ring * cos_turn) << " " << moved(cos_ring) << " "
        << moved(sin_ring * sin_turn) << "\n";
  };
  point(0, 0);
  for (std::uint32_t r = 1; r < rings; ++r) {
    for (std::uint32_t a = 0; a < around; ++a) point(kPi * r / rings, 2 * kPi * a / around);
  }
  point(kPi, 0);
  const std::uint32_t last = first + 1 + (rings - 1) * around;
  const auto at = [&](std::uint32_t r, std::uint32_t a) {
    return r == 0 ? first : r == rings ? last : first + 1 + (r - 1) * around + a % around;
  };
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t a = 0; a < around; ++a) {
      if (r > 0) out << "f " << at(r, a) << " " << at(r, a + 1) << " " << at(r + 1, a) << "\n";
      if (r + 1 < rings) {
        out << "f " << at(r, a + 1) << " " << at(r + 1, a + 1) << " " << at(r + 1, a) << "\n";
      }
    }
  }
}

/// Writes a unit ball, a vertex of which is moved through the other side.
void write_pierced_ball(const std::string& file, std::uint32_t around) {
  write_ball(file, around, 0);
  std::ifstream in(file);
  std::string text, line;
  std::getline(in, line);  // the pole, at height 1
  while (std::getline(in, line)) text += line + "\n";
  std::ofstream(file) << "v 0.1 -1.4 0.05\n" << text;
}

struct Box {
  Vec3 low, high;
  bool from_inside = false;
};

/// Writes boxes that share no vertices, each face with four corners.
void write_boxes(const std::string& file, const std::vector<Box>& boxes) {
  std::ofstream out(file);
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  int first = 1;
  for (const Box& box : boxes) {
    for (int i = 0; i < 8; ++i) {
      out << "v";
      for (int axis = 0; axis < 3; ++axis)
        out << " " << ((i >> axis & 1) != 0 ? box.high : box.low)[axis];
      out << "\n";
    }
    for (const auto& face : kFaces) {
      out << "f";
      for (int i = 0; i < 4; ++i) out << " " << first + face[box.from_inside ? 3 - i : i];
      out << "\n";
    }
    first += 8;
  }
}

Figures broken(const std::string& file, const std::string& more = "") {
  const Outcome outcome =
      sunder("fracture " + file + " --pattern voronoi:20 --quiet --json - " + more);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome.exit_code == 0 ? parse_figures(outcome.out, file) : Figures();
}

std::int64_t count(const Figures& json, const char* key) {
  return std::get<std::int64_t>(json.at(key));
}

TEST(HardMeshes, ATangledMeshGetsANewSurfaceOrIsRefused) {
  const Folder folder;
  const std::string file = folder / "tangled.obj";
  write_ball(file, 24, 0.9);
  const Figures json = broken(file);
  EXPECT_EQ(count(json, "/negative_volumes"), 0);
  EXPECT_EQ(count(json, "/open_edges"), 0);
  EXPECT_EQ(count(json, "/failed"), 0);
  const std::string repair = std::get<std::string>(json.at("/input/repairs/0"));
  EXPECT_NE(repair.find("winding-number shell"), std::string::npos) << repair;
  const Outcome refused = sunder("fracture " + file + " --pattern voronoi:20 --repair off");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("the mesh intersects itself"), std::string::npos) << refused.err;
}

TEST(HardMeshes, TheVolumeThatOverlapsCountTwiceIsReported) {
  const Folder folder;
  const std::string file = folder / "balls.obj";
  write_ball(file, 24, 0);
  EXPECT_EQ(std::get<double>(broken(file).at("/volume_doubled_m3")), 0);
  write_ball(file, 24, 0, 1.0, true, 1 + 2 + 11 * 24);
  // Balls of radius 1 at distance 1 have a lens of 5π/12 in common; flat faces make it smaller.
  const double lens = 5 * kPi / 12;
  const double doubled = std::get<double>(broken(file, "--nodes 2").at("/volume_doubled_m3"));
  EXPECT_LT(doubled, lens);
  EXPECT_GT(doubled, 0.94 * lens);
}

TEST(HardMeshes, NoPieceHasANegativeVolume) {
  const Box unit = {Vec3::Zero(), Vec3::Ones()};
  const Box inside_out = {Vec3::Zero(), Vec3::Ones(), true};
  const Box at_an_edge = {Vec3(1, 1, 0), Vec3(2, 2, 1)};
  const std::vector<std::vector<Box>> inputs = {
      {unit, inside_out},                                // every face both ways
      {unit, at_an_edge},                                // four faces about an edge
      {unit, {Vec3::Ones(), Vec3::Constant(2)}},         // two that touch in a vertex
      {unit, {Vec3(0, 0, 0.25), Vec3(0.5, 0.5, 0.75)}},  // one inside, with parts of faces equal
      {unit, {Vec3(0, 0, 0.25), Vec3(0.5, 0.5, 0.75), true}},
      {unit, unit},
      {inside_out},
      {{Vec3::Zero(), Vec3(1, 1, 0)}, unit},  // one without volume
  };
  const Folder folder;
  const std::string file = folder / "boxes.obj";
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    write_boxes(file, inputs[i]);
    const Outcome outcome = sunder("fracture " + file + " --pattern voronoi:20 --quiet --json -");
    ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 2) << i << "\n" << outcome.err;
    if (outcome.exit_code == 2) {
      EXPECT_NE(outcome.err.find("boxes.obj"), std::string::npos) << i << "\n" << outcome.err;
      continue;
    }
    const Figures json = parse_figures(outcome.out, file);
    EXPECT_EQ(count(json, "/negative_volumes"), 0) << i;
    EXPECT_EQ(count(json, "/open_edges"), 0) << i;
  }
}

TEST(HardMeshes, ACubeThatOccursTwiceIsOneSolid) {
  const Folder folder;
  const std::string file = folder / "cubes.obj";
  const Vec3 step = Vec3::Constant(1e-8);
  write_boxes(file, {{Vec3::Zero(), Vec3::Ones()}, {step, Vec3::Ones() + step}});
  const Figures json = broken(file);
  EXPECT_EQ(count(json, "/pieces"), 20);
  EXPECT_EQ(count(json, "/watertight_pieces"), 20);
  EXPECT_EQ(count(json, "/convexes"), 20);
  EXPECT_NEAR(std::get<double>(json.at("/volume_out_m3")), 1, 1e-7);
}

TEST(HardMeshes, APartThatIsInsideOutIsNotHiddenAsNegativeDebris) {
  const Folder folder;
  const std::string file = folder / "pierced.obj";
  // A vertex of the ball is moved through its other side.
  write_pierced_ball(file, 24);
  for (const std::string pattern : {"voronoi:8", "voronoi:20", "slabs:8"}) {
    const Outcome outcome =
        sunder("fracture " + file + " --pattern " + pattern + " --quiet --json -");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Figures json = parse_figures(outcome.out, file);
    EXPECT_GE(std::get<double>(json.at("/debris_volume_m3")), 0) << pattern;
    EXPECT_LE(std::get<double>(json.at("/volume_error")), 1e-12) << pattern;
    EXPECT_NEAR(std::get<double>(json.at("/volume_out_m3")),
                std::get<double>(json.at("/volume_in_m3")), 1e-9)
        << pattern;
    EXPECT_EQ(count(json, "/watertight_pieces"), count(json, "/pieces")) << pattern;
  }
}

TEST(HardMeshes, TheVolumeOfADecompositionIsThatOfTheUnion) {
  const Folder folder;
  const std::string file = folder / "boxes.obj";
  const auto decomposed = [&](const std::vector<Box>& boxes) {
    write_boxes(file, boxes);
    const Outcome outcome = sunder("vacd " + file + " --quiet --json -");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return parse_figures(outcome.out, file);
  };
  const Box large = {Vec3::Zero(), Vec3::Constant(3)};
  const Figures nested = decomposed({large, {Vec3::Ones(), Vec3::Constant(2)}});
  EXPECT_NEAR(std::get<double>(nested.at("/volume_m3")), 27, 1e-12);
  EXPECT_NEAR(std::get<double>(nested.at("/surface_volume_m3")), 28, 1e-12);
  EXPECT_EQ(std::get<std::string>(nested.at("/volume_method")), "exact");
  const Figures crossing = decomposed({large, {Vec3(1, 1, -1), Vec3(2, 2, 4)}});
  EXPECT_NEAR(std::get<double>(crossing.at("/volume_m3")), 29, 1e-12);
}

// With the usual number of nodes 1.5 to 6.4 % of the volume of these meshes is not broken.
TEST(HardMeshes, MeshesThatWouldNotBreakAreDecomposedWithMoreNodes) {
  const Folder folder;
  for (const std::uint64_t seed : {146u, 227u}) {
    const std::string file = folder / "hard.obj";
    test::write_obj(file, test::make_hard_mesh(seed));
    const Figures json = broken(file);
    EXPECT_EQ(count(json, "/failed"), 0) << seed;
    EXPECT_EQ(std::get<double>(json.at("/failed_volume_m3")), 0) << seed;
  }
}

TEST(HardMeshes, LongWorkReportsItsProgressUnlessQuiet) {
  const Folder folder;
  const std::string file = folder / "large.obj";
  write_ball(file, 600, 0);
  const std::string command = "vacd " + file + " --convexes 64 --json -";
  const Outcome told = sunder(command);
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_NE(told.err.find("% done"), std::string::npos) << told.err;
  EXPECT_TRUE(parse_figures(told.out, "stdout").contains("/convexes"));
  EXPECT_EQ(sunder(command + " --quiet").err, "");
}

}  // namespace
}  // namespace sunder::tests
