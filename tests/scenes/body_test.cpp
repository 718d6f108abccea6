// Tests of bodies from meshes, their cache between runs, and the fracture patterns of materials.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/compound_file.h"
#include "scenes/file/keys.h"
#include "scenes/file/mesh_cache.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHead = "[scene]\ndescription = \"x\"\n";

/// A folder for meshes, with its own cache.
class Bodies : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "sunder-body-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    setenv("SUNDER_CACHE", (folder_ / "cache").c_str(), 1);
  }
  void TearDown() override {
    unsetenv("SUNDER_CACHE");
    fs::remove_all(folder_);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Scene load(const std::string& lines) const {
    return parse_scene(kHead + lines, (folder_ / "scene.toml").string(), {});
  }
  std::string refusal(const std::string& lines) const {
    try {
      load(lines);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  }
  std::vector<fs::path> cached_files() const {
    std::vector<fs::path> files;
    if (!fs::exists(folder_ / "cache")) return files;
    for (const auto& entry : fs::directory_iterator(folder_ / "cache")) {
      files.push_back(entry.path());
    }
    return files;
  }

  fs::path folder_;
};

/// Returns a box as OBJ, with vertices numbered from `first`.
std::string box_obj(const Vec3& min, const Vec3& max, int first = 1) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(),
                      i & 4 ? max.z() : min.z());
    text += "v " + format(corner.x()) + " " + format(corner.y()) + " " + format(corner.z()) + "\n";
  }
  for (const auto& face :
       {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4},
        std::array{2, 6, 7, 3}, std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}}) {
    text += "f";
    for (const int corner : face) text += " " + std::to_string(first + corner);
    text += "\n";
  }
  return text;
}

TEST_F(Bodies, StandOnTheirFootScaledAndTurned) {
  write("box.obj", box_obj({10, 5, -3}, {12, 6, -2}));
  const Scene scene = load(
      "[[body]]\nmesh = \"box.obj\"\nscale = 2\nposition = [1, 3, 1]\nrotation_deg = [0, 90, 0]\n"
      "velocity = [0, 1, 0]\nmaterial = \"wood\"\nnodes = 3\n");
  ASSERT_EQ(scene.solids.size(), 1u);
  const Solid& solid = scene.solids[0];
  EXPECT_EQ(solid.name, "box");
  EXPECT_EQ(solid.velocity_W, Vec3(0, 1, 0));
  EXPECT_NEAR(volume(solid.compound), 16, 1e-9);
  EXPECT_EQ(solid.compound.convexes.size(), 3u);
  EXPECT_EQ(scene.materials[solid.compound.convexes[0]->material.value].name, "wood");
  const Box box_R = bounds(solid.compound);
  const Vec3 foot(box_R.center().x(), box_R.min.y(), box_R.center().z());
  EXPECT_NEAR((solid.X_WR * foot - Vec3(1, 3, 1)).norm(), 0, 1e-9);
}

TEST_F(Bodies, TakeTheirSizeFromTheLongestSide) {
  write("box.obj", box_obj({0, 0, 0}, {400, 100, 200}));
  const Scene scene = load("[[body]]\nmesh = \"box.obj\"\nsize_m = 2\n");
  EXPECT_NEAR(bounds(scene.solids[0].compound).extent().maxCoeff(), 2, 1e-9);
}

TEST_F(Bodies, CanBeBuiltIn) {
  const Scene scene = load("[[body]]\nmesh = \"torus:1,0.3\"\nanchored = \"bottom\"\n");
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_TRUE(scene.solids[0].compound.is_anchored());
  EXPECT_EQ(scene.solids[0].compound.convexes.size(), 16u);
}

TEST_F(Bodies, ColumnsThatReachIntoTheirRoofAreOneSolid) {
  write("temple.obj", box_obj({0, 0, 0}, {.5, 3, .5}) + box_obj({3, 0, 0}, {3.5, 3, .5}, 9) +
                          box_obj({-.5, 2.5, -.5}, {4, 3.5, 1}, 17));
  const Scene scene = load("[[body]]\nmesh = \"temple.obj\"\nnodes = 3\n");
  ASSERT_EQ(scene.solids.size(), 1u) << "held together by ghosts";
  EXPECT_GE(scene.solids[0].compound.ghosts.size(), 2u);
}

TEST_F(Bodies, PartsThatDoNotTouchAreSolidsOfTheirOwn) {
  write("two.obj", box_obj({0, 0, 0}, {1, 1, 1}) + box_obj({3, 0, 0}, {4, 1, 1}, 9));
  const Scene scene = load("[[body]]\nmesh = \"two.obj\"\nname = \"pair\"\nnodes = 2\n");
  ASSERT_EQ(scene.solids.size(), 2u);
  EXPECT_EQ(scene.solids[0].name, "pair.0");
  EXPECT_EQ(scene.solids[1].name, "pair.1");
}

TEST_F(Bodies, AreDecomposedOnceAndCachedBitForBit) {
  write("box.obj", box_obj({0, 0, 0}, {1, 2, 3}));
  const std::string lines = "[[body]]\nmesh = \"box.obj\"\nnodes = 5\n";
  const auto bytes = [&](const Scene& scene) {
    ByteWriter out;
    put(out, scene.solids[0].compound);
    return out.bytes;
  };
  const std::vector<std::byte> made = bytes(load(lines));
  ASSERT_EQ(cached_files().size(), 1u);
  const std::vector<std::byte> file = read_file(cached_files()[0]);
  EXPECT_EQ(bytes(load(lines)), made);
  EXPECT_EQ(cached_files().size(), 1u);
  load("[[body]]\nmesh = \"box.obj\"\nnodes = 6\n");
  EXPECT_EQ(cached_files().size(), 2u) << "other options, another entry";
}

TEST_F(Bodies, ACacheOfOtherBitsIsNotRead) {
  const RawMesh mesh = cache_probe();
  const fracture::VacdOptions options;
  const std::uint64_t digest = decomposition_digest(mesh);
  EXPECT_EQ(cache_key(mesh, options, "auto", digest), cache_key(mesh, options, "auto"));
  MeshSolid stored;
  stored.vacd.emplace();
  store_cached(cache_key(mesh, options, "auto"), stored);
  ASSERT_TRUE(load_cached(cache_key(mesh, options, "auto", digest)));
  for (const std::size_t vertex : {std::size_t{0}, mesh.vertices.size() - 1}) {
    RawMesh other = mesh;
    double& x = other.vertices[vertex].x();
    x = std::nextafter(x, 2.0);  // the last bit of one coordinate
    const std::uint64_t other_digest = decomposition_digest(other);
    EXPECT_NE(other_digest, digest) << vertex;
    EXPECT_FALSE(load_cached(cache_key(mesh, options, "auto", other_digest))) << vertex;
  }
}

TEST_F(Bodies, TheEntriesUsedLongestAgoLeaveTheCache) {
  MeshSolid solid;
  solid.vacd.emplace();
  for (const std::uint64_t key : {1, 2, 3}) store_cached(key, solid);
  const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const fs::path& file : cached_files()) fs::last_write_time(file, hour_ago);
  const std::uintmax_t size = fs::file_size(cached_files()[0]);
  EXPECT_TRUE(load_cached(2));  // used now
  trim_cache(2 * size);
  EXPECT_EQ(cached_files().size(), 2u);
  trim_cache(size);
  EXPECT_EQ(cached_files().size(), 1u);
  EXPECT_TRUE(load_cached(2));
}

TEST_F(Bodies, OfOtherOptionsOrAnotherMeshAreNotTakenFromTheCache) {
  const auto textured = [](const std::string& first_uv) {
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt " + first_uv +
           "\nvt 1 0\nvt 0 1\nf 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/3 3/2\nf 2/1 3/2 4/3\n";
  };
  write("a.obj", textured("0 0"));
  write("b.obj", textured("0.5 0.5"));
  std::size_t entries = 0;
  for (const std::string options :
       {"mesh = \"a.obj\"\nnodes = 3\n", "mesh = \"b.obj\"\nnodes = 3\n",
        "mesh = \"a.obj\"\nnodes = 4\n", "mesh = \"a.obj\"\nnodes = 3\nsize_m = 2\n",
        "mesh = \"a.obj\"\nnodes = 3\nconvexes = 5\n",
        "mesh = \"a.obj\"\nnodes = 3\nfit = \"14dop\"\n",
        "mesh = \"a.obj\"\nnodes = 3\nrepair = \"off\"\n"}) {
    load("[[body]]\n" + options);
    EXPECT_EQ(cached_files().size(), ++entries) << options;
  }
}

TEST_F(Bodies, ADamagedCacheEntryIsReplaced) {
  write("box.obj", box_obj({0, 0, 0}, {1, 2, 3}));
  const std::string lines = "[[body]]\nmesh = \"box.obj\"\nnodes = 4\n";
  load(lines);
  ASSERT_EQ(cached_files().size(), 1u);
  const std::vector<std::byte> good = read_file(cached_files()[0]);
  for (const std::size_t at : {std::size_t{0}, std::size_t{9}, std::size_t{17}, good.size() / 2}) {
    std::vector<std::byte> bad = good;
    bad[at] ^= std::byte{0x40};
    write_file(cached_files()[0], bad);
    EXPECT_EQ(load(lines).solids.size(), 1u);
    EXPECT_EQ(read_file(cached_files()[0]), good) << at;
  }
  write_file(cached_files()[0], std::vector<std::byte>(good.begin(), good.begin() + 30));
  load(lines);
  EXPECT_EQ(read_file(cached_files()[0]), good);
}

TEST_F(Bodies, FaultsAreNamedWithTheirPlace) {
  write("box.obj", box_obj({0, 0, 0}, {1, 1, 1}));
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::pair<const char*, const char*> faults[] = {
      {"", "scene.toml:3: missing key 'mesh' in [[body]]"},
      {"mesh = \"nowhere.obj\"", "scene.toml:3: "},
      {"mesh = \"flat.obj\"", "encloses no volume"},
      {"mesh = \"box.obj\"\nscale = 0", "scene.toml:5: scale in [[body]] is the number 0"},
      {"mesh = \"box.obj\"\nnodes = 0.5", "scene.toml:5: nodes in [[body]] is the number 0.5"},
      {"mesh = \"box.obj\"\nnodes = \"none.txt\"", "none.txt"},
      {"mesh = \"box.obj\"\nfit = \"loose\"", "scene.toml:3: fit loose: expected aabb"},
      {"mesh = \"box.obj\"\nmaterial = \"cheese\"", "unknown material 'cheese'"},
      {"mesh = \"box.obj\"\nrepair = \"maybe\"", "allowed: auto | off"},
      {"mesh = \"torus:1,2\"", "scene.toml:3: 'torus:1,2' is not a built-in solid"},
      {"mesh = \"torus:1,0.2\"\nscale = 3", "a built-in solid has no scale"},
      {"mesh = \"box.obj\"\nstructure = \"box\"", "unknown key 'structure' in [[body]]"}};
  for (const auto& [lines, message] : faults) {
    const std::string got = refusal(std::string("[[body]]\n") + lines + "\n");
    EXPECT_NE(got.find(message), std::string::npos) << lines << "\n" << got;
  }
}

using Patterns = Bodies;

TEST_F(Patterns, EveryKindCanBeNamed) {
  write("half.obj",
        "v -9 -9 -9\nv 9 -9 -9\nv -9 9 -9\nv 9 9 -9\nv -9 -9 9\nv 9 -9 9\nv -9 9 9\nv 9 9 9\n"
        "g all\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  for (const std::string pattern :
       {"kind = \"radial\", cells = 9", "kind = \"brick\", brick_m = [0.2, 0.1, 0.1]",
        "kind = \"slabs\", cells = 7, jitter = 0", "kind = \"grid\", cells = 4, colors = 6",
        "kind = \"file\", file = \"half.obj\""}) {
    const Scene scene = load("[[material]]\nname = \"x\"\npattern = { " + pattern + " }\n");
    EXPECT_TRUE(scene.materials.back().breakable()) << pattern;
    if (scene.materials.back().pattern.kind == PatternSpec::Kind::kFile) {
      EXPECT_EQ(scene.materials.back().pattern.file, (folder_ / "half.obj").string());
    }
  }
}

TEST_F(Patterns, StrongerImpactsStartFromThePatternOfTheMaterial) {
  const Scene scene = load(
      "[[material]]\nname = \"x\"\nimpact_radius_m = 0.5\n"
      "pattern = { kind = \"voronoi\", cells = 30, falloff = 3 }\n"
      "stronger = [{ energy_J = 100, pattern = { cells = 90 } },\n"
      "            { energy_J = 1e4, impact_radius_m = inf, pattern = { kind = \"radial\" } }]\n");
  const std::vector<ImpactResponse>& stronger = scene.materials.back().stronger;
  ASSERT_EQ(stronger.size(), 2u);
  EXPECT_EQ(stronger[0].pattern.cells, 90);
  EXPECT_EQ(stronger[0].pattern.falloff, 3);
  EXPECT_EQ(stronger[0].impact_radius_m, 0.5);
  EXPECT_EQ(stronger[1].pattern.kind, PatternSpec::Kind::kRadial);
  EXPECT_TRUE(std::isinf(stronger[1].impact_radius_m));
}

TEST_F(Patterns, FaultsAreNamedWithTheirPlace) {
  write("bad.obj", "v 1 2 3\n");
  const std::pair<const char*, const char*> faults[] = {
      {"pattern = { kind = \"hexagons\" }", "scene.toml:5: kind in [material.pattern]"},
      {"pattern = { kind = \"grid\", cells = 31 }", "scene.toml:5: cells in [material.pattern]"},
      {"pattern = { kind = \"brick\", brick_m = [1, 1] }", "brick_m in [material.pattern]"},
      {"pattern = { kind = \"brick\", brick_m = [1, 1, 0] }", "brick_m in [material.pattern]"},
      {"pattern = { kind = \"file\" }", "needs file"},
      {"pattern = { kind = \"file\", file = \"nowhere.obj\" }", "nowhere.obj: cannot be read"},
      {"pattern = { kind = \"file\", file = \"bad.obj\" }", "bad.obj:"},
      {"pattern = { kind = \"voronoi\", colors = -1 }", "colors in [material.pattern]"},
      {"stronger = [{ impact_radius_m = 1 }]", "missing key 'energy_J' in [[material.stronger]]"},
      {"stronger = [{ energy_J = 5 }, { energy_J = 5 }]", "sort the entries by energy_J"},
      {"stronger = [{ energy_J = 5, patern = {} }]", "did you mean 'pattern'"},
      {"stronger = { energy_J = 5 }", "expected an array of tables"}};
  for (const auto& [lines, message] : faults) {
    const std::string got = refusal(std::string("[[material]]\nname = \"x\"\n") + lines + "\n");
    EXPECT_NE(got.find(message), std::string::npos) << lines << "\n" << got;
    EXPECT_EQ(got.find((folder_ / "scene.toml:").string()), 0u) << got;
  }
}

}  // namespace
}  // namespace sunder::scenes
