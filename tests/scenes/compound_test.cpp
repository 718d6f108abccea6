// Tests of compounds of listed parts, and of copies in rows, rings and mirrors.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"

namespace sunder::scenes::compound_test {
namespace {

constexpr const char* kHead = "[scene]\ndescription = \"x\"\n";
constexpr const char* kCompound = "[[solid]]\nstructure = \"compound\"\n";

Scene scene_of(const std::string& lines) { return parse_scene(kHead + lines, "x.toml", {}); }

std::string refusal(const std::string& lines) {
  try {
    scene_of(lines);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string part(const std::string& structure, const std::string& lines = "") {
  return "[[solid.part]]\nstructure = \"" + structure + "\"\n" + lines + "\n";
}

double bonded_m2(const Compound& compound) {
  double sum = 0;
  for (const Bond& bond : compound.bonds) sum += bond.area_m2;
  return sum;
}

Vec3 com_W(const Scene& scene, const Solid& solid) {
  return solid.X_WR * mass_of(solid.compound, scene.materials).com_R;
}

TEST(CompoundStructure, CountsOverlapsOnceWithTheDensityOfTheFirstPart) {
  const std::string steel = part("box", "material = \"steel\""),
                    wood = part("box", "material = \"wood\"\nposition = [0.75, 0, 0]");
  for (const bool steel_first : {true, false}) {
    const Scene scene = scene_of(kCompound + (steel_first ? steel + wood : wood + steel));
    ASSERT_EQ(scene.solids.size(), 1u);
    EXPECT_NEAR(volume(scene.solids[0].compound), 1.75, 1e-12);
    const double heavy = scene.materials[material_named(scene, "steel").value].density_kg_m3;
    const double light = scene.materials[material_named(scene, "wood").value].density_kg_m3;
    const double mass_kg = steel_first ? heavy + 0.75 * light : 0.75 * heavy + light;
    EXPECT_NEAR(mass_of(scene.solids[0].compound, scene.materials).mass_kg, mass_kg,
                1e-9 * mass_kg);
  }
}

TEST(CompoundStructure, BondsPartsByTheAreaTheyShare) {
  // A cube turned by 45 degrees on a slab, a column on it, a prism flush with the slab's side.
  const Scene scene =
      scene_of(kCompound + part("box", "size_m = [4, 1, 4]") +
               part("box", "position = [0, 1, 0]\nrotation_deg = [0, 45, 0]") +
               part("column", "radius_m = 0.25\nsides = 64\nposition = [0, 2, 0]") +
               part("prism", "outline_m = [[2, 0], [3, 0], [2, 0.5]]\ndepth_m = 2"));
  ASSERT_EQ(scene.solids.size(), 1u);
  const double disc_m2 = 32 * 0.25 * 0.25 * std::sin(2 * M_PI / 64);
  EXPECT_EQ(scene.solids[0].compound.bonds.size(), 3u);
  EXPECT_NEAR(bonded_m2(scene.solids[0].compound), 1 + disc_m2 + 0.5 * 2, 1e-9);
  EXPECT_NEAR(volume(scene.solids[0].compound), 16 + 1 + 3 * disc_m2 + 0.5, 1e-9);
}

TEST(CompoundStructure, AnArchHasTheVolumeOfItsChordsAndStandsOnItsFeet) {
  const Scene scene = scene_of(
      "[[solid]]\nstructure = \"arch\"\nspan_m = 3\nring_m = 0.5\ndepth_m = 0.8\nvoussoirs = 9\n"
      "block_m = 0.4\nanchored = \"bottom\"");
  const Compound& arch = scene.solids.at(0).compound;
  ASSERT_EQ(arch.convexes.size(), 9u * 2 + 4) << "two slices of stone, four feet on blocks";
  const double ring_m2 = 9 * 0.5 * std::sin(M_PI / 9) * (2 * 2 - 1.5 * 1.5);
  double stone_m3 = 0;
  for (std::size_t c = 0; c < 18; ++c) stone_m3 += arch.convexes[c]->solid.volume_m3;
  EXPECT_NEAR(stone_m3, 0.8 * ring_m2, 1e-9);
  EXPECT_EQ(scene.solids.size(), 1u);
}

TEST(CompoundStructure, MayHaveCompoundsAsParts) {
  const std::string group =
      "[[solid.part]]\nstructure = \"compound\"\nmirror = \"x\"\n"
      "[[solid.part.part]]\nstructure = \"box\"\nposition = [0.5, 0, 0]\n"
      "[[solid.part.part]]\nstructure = \"box\"\nposition = [0.5, 1, 0]\n";
  const Scene scene = scene_of(kCompound + group);
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_EQ(scene.solids[0].compound.convexes.size(), 4u);
  EXPECT_NEAR(bonded_m2(scene.solids[0].compound), 4, 1e-9);
}

TEST(CompoundStructure, BondsAMeshByTheFaceThatItStandsOn) {
  const Scene scene = scene_of(kCompound + part("box", "size_m = [2, 1, 2]") +
                               part("mesh", "mesh = \"column:0.3,2\"\nposition = [0, 1, 0]"));
  ASSERT_EQ(scene.solids.size(), 1u);
  const Compound& compound = scene.solids[0].compound;
  EXPECT_EQ(compound.bonds.size(), 1u);
  EXPECT_NEAR(bounds(compound).extent().y(), 3, 1e-9);
}

TEST(CompoundStructure, RefusesAPartWithoutABond) {
  const std::string box = part("box");
  EXPECT_EQ(refusal(kCompound + box + part("box", "position = [0, 1, 0]") +
                    part("box", "position = [1.25, 0, 0]")),
            "x.toml:11: [[solid.part]] is not connected to the others: it shares no face with "
            "another part, and overlaps none; the nearest is 0.25 m away; move it, or make it a "
            "separate [[solid]]");
  EXPECT_TRUE(refusal(kCompound + box + part("box", "position = [1, 1, 0]"))
                  .starts_with("x.toml:8: [[solid.part]] is not connected"))
      << "a shared edge is no bond";
  EXPECT_EQ(refusal(kCompound + box + part("box", "position = [1, 0.5, 0]")), "");
}

TEST(CompoundStructure, RefusesFaultsWithTheirPlace) {
  EXPECT_EQ(refusal(kCompound), "x.toml:3: missing [[solid.part]]: a compound has at least one");
  EXPECT_TRUE(refusal(kCompound + std::string("part = 3")).starts_with("x.toml:5: [[part]] is"));
  EXPECT_TRUE(refusal(kCompound + part("house", "storey = 3"))
                  .starts_with("x.toml:7: unknown key 'storey' in [[solid.part]] house; did you "
                               "mean 'storeys'?"));
  EXPECT_TRUE(refusal(kCompound + part("bx")).starts_with("x.toml:6: unknown structure 'bx'; did"));
  EXPECT_TRUE(refusal(kCompound + part("prism", "outline_m = [[0, 0], [2, 0], [1, 0.1], [1, 2]]"))
                  .starts_with("x.toml:5: prism: outline_m is not convex"));
  for (const char* outline : {"[[0, 0], [1, 0]]", "[[0, 0], [1, 0], 3]", "[[0, 0], [1, 0], [0]]",
                              "[[0, 0], [1, 0], [0, \"x\"]]", "7"}) {
    const std::string said =
        refusal(kCompound + part("prism", std::string("outline_m = ") + outline));
    EXPECT_TRUE(said.starts_with("x.toml:7: outline_m in [[solid.part]] prism is") &&
                said.ends_with("allowed: [[x, y], ...], 3 to 64 corners, each a number from -1000 "
                               "to 1000, in m"))
        << said;
  }
  EXPECT_EQ(refusal("[[solid]]\nstructure = \"box\"\nrepeat = [{ count = 1000, turn_deg = 1 }, { "
                    "count = 21, turn_deg = 2 }]"),
            "x.toml:5: 21000 copies by repeat; allowed: at most 20000");
  EXPECT_TRUE(refusal("[[solid]]\nstructure = \"box\"\nrepeat = { count = 0 }")
                  .starts_with("x.toml:5: count in [solid.repeat], [solid.part.repeat], "
                               "[body.repeat] is the number 0; allowed: a whole number from 1"));
  EXPECT_TRUE(refusal("[[solid]]\nstructure = \"box\"\nrepeat = { cuont = 2 }")
                  .starts_with("x.toml:5: unknown key 'cuont'"));
  EXPECT_EQ(refusal("[[solid]]\nstructure = \"box\"\nrepeat = { count = 2 }"),
            "x.toml:5: repeat puts all copies at one place; add step_m, turn_rad or turn_deg");
  EXPECT_TRUE(refusal("[[solid]]\nstructure = \"box\"\nrepeat = 3").starts_with("x.toml:5: "));
  EXPECT_TRUE(
      refusal(
          "[[solid]]\nstructure = \"box\"\nblock_m = 0.05\nrepeat = { count = 100, turn_deg = 3 }")
          .starts_with("x.toml:3: 8e+05 parts; allowed: at most 200000"));
}

TEST(Copies, StandInARowAndHaveUniqueNames) {
  const Scene scene = scene_of(
      "[[solid]]\nstructure = \"box\"\nname = \"post\"\nposition = [1, 0, 0]\n"
      "repeat = [{ count = 3, step_m = [2, 0, 0] }, { count = 2, step_m = [0, 0, 5] }]\n"
      "[[solid]]\nstructure = \"box\"\nposition = [0, 9, 0]");
  ASSERT_EQ(scene.solids.size(), 7u);
  std::set<std::string> names;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3 expected(1 + 2.0 * static_cast<double>(i % 3), 0, i < 3 ? 0 : 5);
    EXPECT_EQ(scene.solids[i].X_WR.position, expected);
    EXPECT_EQ(scene.solids[i].name, "post." + std::to_string(i));
    names.insert(scene.solids[i].name);
  }
  names.insert(scene.solids[6].name);
  EXPECT_EQ(names.size(), 7u);
}

TEST(Copies, StandInARingWithTheirFrontsInward) {
  const Scene scene = scene_of(
      "[[solid]]\nstructure = \"box\"\nsize_m = [1, 2, 3]\nposition = [11, 0, 2]\n"
      "velocity = [1, 0, 0]\nrepeat = { count = 12, turn_deg = 30, center_m = [1, 0, 2] }");
  ASSERT_EQ(scene.solids.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const double angle = static_cast<double>(i) * M_PI / 6;
    const Vec3 out(std::cos(angle), 0, -std::sin(angle));
    const Solid& solid = scene.solids[i];
    EXPECT_NEAR((solid.X_WR.position - Vec3(1, 0, 2) - 10 * out).norm(), 0, 1e-9);
    EXPECT_NEAR((solid.X_WR.rotation * Vec3::UnitX() - out).norm(), 0, 1e-12);
    EXPECT_NEAR((solid.velocity_W - out).norm(), 0, 1e-12);
  }
}

/// A wedge that differs from each of its mirror images, rotated about all axes.
const char* const kWedge =
    "structure = \"prism\"\noutline_m = [[0, 0], [2, 0], [0.3, 1]]\ndepth_m = 0.7\n"
    "position = [3, 1, 2]\nrotation_deg = [20, 50, -35]\n";

TEST(Copies, AreMirroredPointByPoint) {
  const std::pair<const char*, std::vector<Vec3>> kMirrors[] = {
      {"x", {{-1, 1, 1}}},
      {"y", {{1, -1, 1}}},
      {"z", {{1, 1, -1}}},
      {"xz", {{-1, 1, 1}, {1, 1, -1}, {-1, 1, -1}}}};
  const Vec3 at(0.5, 0.25, -1);
  for (const auto& [mirror, signs] : kMirrors) {
    const Scene scene = scene_of("[[solid]]\n" + std::string(kWedge) +
                                 "velocity = [1, 2, 3]\nangular_velocity = [4, 5, 6]\n" +
                                 "mirror = \"" + mirror + "\"\nmirror_at_m = [0.5, 0.25, -1]");
    ASSERT_EQ(scene.solids.size(), 1 + signs.size()) << mirror;
    const Solid& first = scene.solids[0];
    for (std::size_t i = 0; i < signs.size(); ++i) {
      const Solid& image = scene.solids[i + 1];
      const Convex& convex = *image.compound.convexes[0];
      EXPECT_TRUE(is_closed(convex.polyhedron));
      EXPECT_GT(mass_properties(convex.polyhedron).volume_m3, 0) << "outward";
      const Vec3& sign = signs[i];
      const auto reflect = [&](const Vec3& p) { return Vec3(at + sign.cwiseProduct(p - at)); };
      for (const Vec3& vertex : first.compound.convexes[0]->polyhedron.vertices) {
        double nearest = 1e9;
        for (const Vec3& other : convex.polyhedron.vertices) {
          nearest = std::min(nearest, (image.X_WR * other - reflect(first.X_WR * vertex)).norm());
        }
        EXPECT_NEAR(nearest, 0, 1e-12) << mirror;
      }
      EXPECT_NEAR((image.velocity_W - signs[i].cwiseProduct(Vec3(1, 2, 3))).norm(), 0, 1e-12);
      const Vec3 spin = signs[i].prod() * signs[i].cwiseProduct(Vec3(4, 5, 6));
      EXPECT_NEAR((image.angular_velocity_W - spin).norm(), 0, 1e-12) << mirror;
    }
  }
}

TEST(Copies, OfBodiesAreMirroredToo) {
  const Scene scene = scene_of(
      "[[body]]\nmesh = \"voronoi:12\"\nposition = [5, 0, 0]\nrotation_deg = [0, 30, 10]\n"
      "mirror = \"x\"\nrepeat = { count = 2, step_m = [3, 0, 0] }");
  ASSERT_EQ(scene.solids.size(), 4u);
  const Solid& first = scene.solids[0];
  EXPECT_EQ(scene.solids[1].X_WR.position.x(), first.X_WR.position.x() + 3);
  for (const std::size_t i : {2u, 3u}) {
    const Vec3 com = com_W(scene, scene.solids[i - 2]), image = com_W(scene, scene.solids[i]);
    EXPECT_NEAR((image - Vec3(-com.x(), com.y(), com.z())).norm(), 0, 1e-9);
    EXPECT_NEAR(volume(scene.solids[i].compound), volume(first.compound), 1e-9);
    EXPECT_NEAR(bonded_m2(scene.solids[i].compound), bonded_m2(first.compound), 1e-9);
  }
}

TEST(Copies, OfStructuresOfSeveralSolidsKeepTheirOrder) {
  const Scene scene = scene_of(
      "[[solid]]\nstructure = \"stack\"\ncount = 3\nposition = [2, 0, 0]\nmirror = \"x\"\n"
      "anchored = \"bottom\"");
  ASSERT_EQ(scene.solids.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(com_W(scene, scene.solids[i]).x() > 0, i < 3);
    EXPECT_EQ(scene.solids[i].compound.is_anchored(), i % 3 == 0);
  }
}

TEST(Anchored, DecidesAlsoForStructuresThatStandOnFeetOfTheirOwn) {
  struct Case {
    const char *structure, *anchored;
    bool stands;
  };
  for (const Case& c : {Case{"pane", "", true},
                        {"pane", "none", false},
                        {"pane", "bottom", true},
                        {"pane", "all", true},
                        {"pane", "own", true},
                        {"hall", "", true},
                        {"hall", "none", false},
                        {"arena", "", true},
                        {"arena", "none", false},
                        {"box", "", false},
                        {"box", "own", false},
                        {"box", "bottom", true}}) {
    std::string lines = "[[solid]]\nstructure = \"" + std::string(c.structure) + "\"\n";
    if (c.anchored[0] != 0) lines += "anchored = \"" + std::string(c.anchored) + "\"\n";
    const Scene scene = scene_of(lines);
    const bool stands = std::ranges::any_of(
        scene.solids, [](const Solid& solid) { return solid.compound.is_anchored(); });
    EXPECT_EQ(stands, c.stands) << lines;
  }
}

TEST(Anchored, AllAnchorsEveryPartOnEverySide) {
  for (const char* lines : {"[[solid]]\nstructure = \"house\"\nanchored = \"all\"",
                            "[[body]]\nmesh = \"torus:1,0.3\"\nanchored = \"all\""}) {
    const Scene scene = scene_of(lines);
    for (const std::uint8_t anchored : scene.solids.at(0).compound.anchored) {
      EXPECT_EQ(anchored, kAnchoredAllSides);
    }
  }
}

TEST(CompoundStructure, IsTheSameBitsEachTime) {
  const std::string lines = kCompound + part("box", "size_m = [4, 1, 4]\nblock_m = 0.7") +
                            part("column", "position = [0.1, 0.9, 0]\nrotation_deg = [3, 20, 7]") +
                            part("arch", "position = [0, 1, 0]\nspan_m = 2");
  const Scene a = scene_of(lines), b = scene_of(lines);
  ASSERT_EQ(a.solids.size(), 1u);
  const Compound &one = a.solids[0].compound, &two = b.solids[0].compound;
  ASSERT_EQ(one.convexes.size(), two.convexes.size());
  ASSERT_EQ(one.bonds.size(), two.bonds.size());
  EXPECT_GT(one.ghosts.size(), 0u);
  ASSERT_EQ(one.ghosts.size(), two.ghosts.size());
  for (std::size_t c = 0; c < one.convexes.size(); ++c)
    EXPECT_EQ(one.convexes[c]->polyhedron.vertices, two.convexes[c]->polyhedron.vertices);
  for (std::size_t i = 0; i < one.bonds.size(); ++i)
    EXPECT_EQ(one.bonds[i].area_m2, two.bonds[i].area_m2);
}

}  // namespace
}  // namespace sunder::scenes::compound_test
